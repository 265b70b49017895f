"""Action clients, which send goals and get feedback and results over three services and two topics under ``NAME/_action``."""

from __future__ import annotations

import weakref
from binascii import crc32
from collections.abc import Callable
from types import GenericAlias
from typing import Any, Self

from kit.msg.action_msgs import CancelGoal, GoalStatus, GoalStatusArray
from kit.msg.message import Action
from kit.msg.unique_identifier_msgs import UUID
from kit.ros.action.goal_states import ENDED, FEEDBACK_QOS_PROFILE, uuid_bytes
from kit.ros.exceptions import InvalidHandle
from kit.ros.execution.callback_groups import CallbackGroup
from kit.ros.execution.task import Future, Task
from kit.ros.graph.action_names import (
    CANCEL_GOAL,
    FEEDBACK,
    GET_RESULT,
    SEND_GOAL,
    STATUS,
    all_served_actions,
)
from kit.ros.node.client import Client
from kit.ros.node.clock import Clock
from kit.ros.node.endpoint import accepted_argument_count, register_entity
from kit.ros.node.node import Node, check_action_type
from kit.ros.node.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from kit.ros.node.service_introspection import ServiceIntrospectionState
from kit.ros.node.time import S_TO_NS

_WARN_AFTER_NS = 5 * S_TO_NS
"""How long to wait for a server before saying what there is instead."""


class ClientGoalHandle:
    """A goal that an action server has accepted or rejected, as its client sees it."""

    # So that annotations such as ClientGoalHandle[Fibonacci] work, as with rclpy's generic classes.
    __class_getitem__: Any = classmethod(GenericAlias)

    def __init__(self, action_client: ActionClient, goal_id: UUID, goal_response: Any) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status: int = GoalStatus.STATUS_UNKNOWN

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other.goal_id

    def __hash__(self) -> int:
        return hash(uuid_bytes(self._goal_id))

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> UUID:
        return self._goal_id

    @property
    def stamp(self) -> Any:
        """When the server accepted it, a ``builtin_interfaces.msg.Time``."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        return bool(self._goal_response.accepted)

    @property
    def status(self) -> int:
        """The status that was last received, a constant of ``GoalStatus``."""
        return self._status

    def cancel_goal(self) -> Any:
        """Asks the server to cancel the goal, and waits for its answer, a ``CancelGoal.Response``.

        Raises as ``ActionClient.send_goal`` does.
        """
        return self._action_client._cancel_goal(self)

    def cancel_goal_async(self) -> Future[Any]:
        """Asks the server to cancel the goal; the future gets its answer."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Waits for the end of the goal; returns its ``status`` and ``result``.

        Raises as ``ActionClient.send_goal`` does.
        """
        return self._action_client._get_result(self)

    def get_result_async(self) -> Future[Any]:
        """Asks for the result; the future gets its ``status`` and ``result`` when the goal has ended."""
        return self._action_client._get_result_async(self)


class _ResponseFuture(Future[Any]):
    """Runs its done callbacks at once, so that a goal is known to be accepted before its feedback comes."""

    def _call(self, callback: Callable[[Future[Any]], Any]) -> None:
        task: Task[Any] = Task(callback, (self,))
        if self._handle is not None:
            task.set_owner(self._handle)
        task()


class _ActionServiceClient(Client[Any, Any]):
    """A client of one of an action's services: its messages speak of the action."""

    def _no_server_text(self) -> str:
        return (
            f"no node serves the action {self._action}: this will never be answered; wait_for_server() first"
        )

    def _server_gone_text(self, waiting: int) -> str:
        calls = "what was asked of it" if waiting == 1 else f"{waiting} requests"
        return f"the server of the action {self._action} has gone: {calls} will never be answered"

    @property
    def _action(self) -> str:
        return f"'{self.service_name.partition('/_action/')[0]}'"


class ActionClient:
    """Sends goals to the server of an action.

    Its callbacks obey ``callback_group``. Raises TypeError for a wrong type, InvalidTopicNameException.
    """

    # So that annotations such as ActionClient[Fibonacci] work, as with rclpy's generic classes.
    __class_getitem__: Any = classmethod(GenericAlias)

    def __init__(
        self,
        node: Node,
        action_type: type[Action],
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = FEEDBACK_QOS_PROFILE,
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        check_action_type(action_type)
        self.action_type = action_type
        self.action_name = node.resolve_topic_name(action_name)
        """Absolute, after remapping."""
        self._node = node
        self._graph = node.handle.graph
        self._group = callback_group or node.default_callback_group
        self._goal_handles: weakref.WeakValueDictionary[bytes, ClientGoalHandle] = (
            weakref.WeakValueDictionary()
        )
        self._feedback_callbacks: dict[bytes, Callable[[Any], Any]] = {}
        self._goal_count = 0
        self._destroyed = False
        impl = action_type.Impl
        self._goal_client = self._make_client(impl.SendGoalService, SEND_GOAL, goal_service_qos_profile)
        self._cancel_client = self._make_client(
            impl.CancelGoalService, CANCEL_GOAL, cancel_service_qos_profile
        )
        self._result_client = self._make_client(impl.GetResultService, GET_RESULT, result_service_qos_profile)
        self._feedback_subscription = node.create_subscription(
            impl.FeedbackMessage,
            f"{self.action_name}/{FEEDBACK}",
            self._on_feedback,
            feedback_sub_qos_profile,
            callback_group=self._group,
        )
        self._status_subscription = node.create_subscription(
            impl.GoalStatusMessage,
            f"{self.action_name}/{STATUS}",
            self._on_status,
            status_sub_qos_profile,
            callback_group=self._group,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def __repr__(self) -> str:
        return f"<action client {self.action_name}>"

    @property
    def node(self) -> Node:
        """The node that it belongs to."""
        return self._node

    # Goals

    def send_goal(self, goal: Any, **kwargs: Any) -> Any:
        """Sends a goal and waits for its end; returns its ``status`` and ``result``.

        Another thread must spin the node meanwhile. Raises TypeError, ServerGoneError if there is no server or it ends
        before the goal does, and WouldDeadlock in a callback that the answer would have to wait for.
        """
        what, instead = f"send_goal() to '{self.action_name}'", "send_goal_async()"
        self._goal_client.raise_if_deadlock(what, instead)
        self._goal_client.raise_if_unserved(what)
        future = self.send_goal_async(goal, **kwargs)
        self._goal_client.wait_until_done(future, what, instead)
        handle = future.result()
        assert handle is not None
        return self._get_result(handle)

    def send_goal_async(
        self, goal: Any, feedback_callback: Callable[[Any], Any] | None = None, goal_uuid: UUID | None = None
    ) -> Future[ClientGoalHandle]:
        """Sends a goal; the future gets a handle when the server has accepted or rejected it.

        ``feedback_callback(message)`` gets each message about this goal, with its ``feedback``. Raises TypeError.
        """
        name = self.action_type.__name__
        if not isinstance(goal, self.action_type.Goal):
            hint = f"; write {name}.Goal()" if goal is self.action_type.Goal else ""
            raise TypeError(f"Expected {name}.Goal, got {type(goal)}, as goal of '{self.action_name}'{hint}")
        if feedback_callback is not None:
            accepted_argument_count(feedback_callback, (1,), f"the feedback of {self.action_name}")
        self._check_not_destroyed()
        goal_id = goal_uuid or self._next_goal_id()
        if feedback_callback is not None:
            self._feedback_callbacks[uuid_bytes(goal_id)] = feedback_callback
        request = self.action_type.Impl.SendGoalService.Request(goal_id=goal_id, goal=goal)

        def handle_of(response: Any) -> ClientGoalHandle:
            handle = ClientGoalHandle(self, goal_id, response)
            if handle.accepted:
                self._goal_handles[uuid_bytes(goal_id)] = handle
            else:
                self._feedback_callbacks.pop(uuid_bytes(goal_id), None)
            return handle

        return self._ask(self._goal_client, request, handle_of)

    @property
    def pending_count(self) -> int:
        """The number of requests whose answers may still come."""
        clients = (self._goal_client, self._cancel_client, self._result_client)
        return sum(client.pending_count for client in clients)

    def server_is_ready(self) -> bool:
        """True if a node serves the action."""
        directory = self._graph.directory
        clients = (self._goal_client, self._cancel_client, self._result_client)
        topics = (self._feedback_subscription.topic_name, self._status_subscription.topic_name)
        return all(client.service_is_ready() for client in clients) and all(
            any(True for _ in directory.publishers(topic)) for topic in topics
        )

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Waits until a node serves the action; True if one does. Seconds of the graph's time.

        Without a time-out it says after a while which actions are served instead.
        """
        graph, context = self._graph, self._node.context
        endless = timeout_sec is None or timeout_sec < 0
        until = None if endless else graph.now_ns + int((timeout_sec or 0.0) * S_TO_NS)
        what = f"wait_for_server() on '{self.action_name}', which no node serves,"

        def is_over() -> bool:
            return self.server_is_ready() or not context.ok()

        if until is None and not graph.wait(is_over, graph.now_ns + _WARN_AFTER_NS, what=what):
            self._node.get_logger().warning(self._waiting_text())
        graph.wait(is_over, until, what=what)
        return self.server_is_ready()

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publishes requests and responses of the action's services on their ``_service_event`` topics."""
        for client in (self._goal_client, self._cancel_client, self._result_client):
            client.configure_introspection(clock, service_event_qos_profile, introspection_state)

    def destroy(self) -> None:
        """Removes the client from the graph; futures that wait for answers stay undone."""
        if self._destroyed:
            return
        self._destroyed = True
        for client in (self._goal_client, self._cancel_client, self._result_client):
            client.destroy()
        self._feedback_subscription.destroy()
        self._status_subscription.destroy()

    # Used by goal handles

    def _cancel_goal(self, goal_handle: ClientGoalHandle) -> Any:
        what, instead = f"cancel_goal() of '{self.action_name}'", "cancel_goal_async()"
        self._cancel_client.raise_if_deadlock(what, instead)
        self._cancel_client.raise_if_unserved(what)
        future = self._cancel_goal_async(goal_handle)
        self._cancel_client.wait_until_done(future, what, instead)
        return future.result()

    def _cancel_goal_async(self, goal_handle: ClientGoalHandle) -> Future[Any]:
        _check_handle(goal_handle)
        self._check_not_destroyed()
        request = CancelGoal.Request()
        request.goal_info.goal_id = goal_handle.goal_id
        return self._ask(self._cancel_client, request, lambda response: response)

    def _get_result(self, goal_handle: ClientGoalHandle) -> Any:
        what, instead = f"get_result() of '{self.action_name}'", "get_result_async()"
        self._result_client.raise_if_deadlock(what, instead)
        self._result_client.raise_if_unserved(what)
        future = self._get_result_async(goal_handle)
        self._result_client.wait_until_done(future, what, instead)
        return future.result()

    def _get_result_async(self, goal_handle: ClientGoalHandle) -> Future[Any]:
        _check_handle(goal_handle)
        self._check_not_destroyed()
        key = uuid_bytes(goal_handle.goal_id)
        request = self.action_type.Impl.GetResultService.Request(goal_id=goal_handle.goal_id)

        def ended(response: Any) -> Any:
            self._feedback_callbacks.pop(key, None)
            return response

        return self._ask(self._result_client, request, ended)

    # Messages

    def _make_client(self, srv_type: type[Any], name: str, profile: QoSProfile) -> _ActionServiceClient:
        handle = self._node.handle
        full_name = self._node.resolve_service_name(f"{self.action_name}/{name}")
        client = _ActionServiceClient(handle, srv_type, full_name, self._group, profile)
        register_entity(handle.clients, client)
        return client

    def _ask(self, client: _ActionServiceClient, request: Any, convert: Callable[[Any], Any]) -> Future[Any]:
        """Sends a request; the future gets what ``convert`` makes of the response."""
        future = _ResponseFuture()
        future.set_owner(self._node.handle, self._group)
        response = client.call_async(request)

        def on_response() -> None:
            if not future.done():
                future.set_result(convert(response.result()))

        response.call_when_done(on_response)
        future.call_when_done(lambda: client.remove_pending_request(response))
        return future

    def _on_feedback(self, message: Any) -> Any:
        callback = self._feedback_callbacks.get(uuid_bytes(message.goal_id))
        return None if callback is None else callback(message)

    def _on_status(self, message: GoalStatusArray) -> None:
        for entry in message.status_list:
            key = uuid_bytes(entry.goal_info.goal_id)
            handle = self._goal_handles.get(key)
            if handle is not None:
                handle._status = entry.status
                if entry.status in ENDED:
                    del self._goal_handles[key]

    def _waiting_text(self) -> str:
        served = all_served_actions(self._graph.directory)
        own = self.action_type.__ros_type__
        types = served.get(self.action_name, [own])
        if own not in types:
            return f"wait_for_server(): '{self.action_name}' is served as {', '.join(types)}, not as {own}"
        there = f"served are: {', '.join(served)}" if served else "no action is served"
        return f"wait_for_server(): no node serves '{self.action_name}' yet; {there}"

    def _next_goal_id(self) -> UUID:
        """An identifier that no other goal has, but the same in every run: of node, client, number and time."""
        self._goal_count += 1
        parts = (
            (crc32(self._node.get_fully_qualified_name().encode()), 4),
            (self._goal_client.number, 3),
            (self._goal_count, 3),
            (self._graph.now_ns // 1000, 6),
        )
        data = b"".join((part % 256**size).to_bytes(size, "big") for part, size in parts)
        numbers: Any = list(data)  # any sequence of numbers is accepted
        return UUID(uuid=numbers)

    def _check_not_destroyed(self) -> None:
        if self._destroyed:
            raise InvalidHandle(
                f"cannot use the client of action '{self.action_name}': it has been destroyed"
            )


def _check_handle(goal_handle: object) -> None:
    if not isinstance(goal_handle, ClientGoalHandle):
        raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
