"""Action servers: they accept goals, execute them, and answer with feedback and results.

An action server is three services and two topics under ``NAME/_action``, so bags, bridges and tools see all of it.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable
from enum import Enum
from types import GenericAlias
from typing import Any, Self

from kit.msg.action_msgs import CancelGoal, GoalInfo, GoalStatus, GoalStatusArray
from kit.msg.message import Action
from kit.msg.unique_identifier_msgs import UUID
from kit.ros.action.goal_states import (
    ENDED,
    FEEDBACK_QOS_PROFILE,
    STATUS_NAMES,
    TRANSITIONS,
    GoalEvent,
    uuid_bytes,
)
from kit.ros.exceptions import RCLError
from kit.ros.execution.callback_groups import CallbackGroup
from kit.ros.execution.task import Future, Task, await_or_execute
from kit.ros.graph.action_names import CANCEL_GOAL, FEEDBACK, GET_RESULT, SEND_GOAL, STATUS
from kit.ros.node.clock import Clock
from kit.ros.node.endpoint import accepted_argument_count, register_entity
from kit.ros.node.node import Node, check_action_type
from kit.ros.node.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from kit.ros.node.service import DeferredService
from kit.ros.node.service_introspection import ServiceIntrospectionState
from kit.ros.node.time import S_TO_NS

Respond = Callable[[Any], None]


class GoalResponse(Enum):
    """What a goal callback returns."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """What a cancel callback returns."""

    REJECT = 1
    ACCEPT = 2


class ServerGoalHandle:
    """A goal that a server has accepted. Safe to use from any thread."""

    # So that annotations such as ServerGoalHandle[Fibonacci] work, as with rclpy's generic classes.
    __class_getitem__: Any = classmethod(GenericAlias)

    def __init__(self, action_server: ActionServer, goal_info: GoalInfo, goal_request: Any) -> None:
        self._action_server = action_server
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._lock = action_server._graph.lock
        self._status: int = GoalStatus.STATUS_ACCEPTED
        self._destroyed = False
        self._ended_ns: int | None = None
        self._result_future: Future[Any] = Future()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerGoalHandle) and self.goal_id == other.goal_id

    def __hash__(self) -> int:
        return hash(uuid_bytes(self.goal_id))

    def __repr__(self) -> str:
        name = self._action_server.action_name
        return f"<goal {uuid_bytes(self.goal_id).hex()} of {name}: {STATUS_NAMES[self.status]}>"

    @property
    def request(self) -> Any:
        """The goal's own message, as ``Fibonacci.Goal``."""
        return self._goal_request

    @property
    def goal_id(self) -> UUID:
        return self._goal_info.goal_id

    @property
    def status(self) -> int:
        """A constant of ``GoalStatus``; unknown once the server has forgotten the goal."""
        with self._lock:
            return GoalStatus.STATUS_UNKNOWN if self._destroyed else self._status

    @property
    def is_active(self) -> bool:
        """True until it has succeeded, was aborted or was canceled."""
        with self._lock:
            return not self._destroyed and self._status not in ENDED

    @property
    def is_cancel_requested(self) -> bool:
        return self.status == GoalStatus.STATUS_CANCELING

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Schedules the callback, by default the server's, for this goal."""
        if not self.is_cancel_requested:
            self._update_state(GoalEvent.EXECUTE)
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Sends feedback to the client. Raises TypeError if it is none of this action's."""
        server = self._action_server
        if not isinstance(feedback, server.action_type.Feedback):
            name = server.action_type.__name__
            raise TypeError(
                f"the feedback of action '{server.action_name}' is a {name}.Feedback, not {type(feedback).__name__}"
            )
        with self._lock:
            if not self._destroyed:
                server._publish_feedback(self._goal_info.goal_id, feedback)

    def succeed(self, response: Any = None) -> None:
        """Ends the goal as reached; ``response`` is its result, where the execute callback returns none.

        Raises RCLError if it has ended, or was never executed; so do ``abort`` and ``canceled``.
        """
        self._end(GoalEvent.SUCCEED, response)

    def abort(self, response: Any = None) -> None:
        """Ends the goal as failed."""
        self._end(GoalEvent.ABORT, response)

    def canceled(self, response: Any = None) -> None:
        """Ends the goal as canceled. Raises RCLError if no client has asked for that."""
        self._end(GoalEvent.CANCELED, response)

    def destroy(self) -> None:
        """Forgets the goal: what is done with it afterwards has no effect."""
        with self._lock:
            self._destroyed = True

    def _end(self, event: GoalEvent, response: Any) -> None:
        self._update_state(event)
        if response is not None:
            self._action_server._set_result(self, response)

    def _update_state(self, event: GoalEvent) -> None:
        with self._lock:
            if self._destroyed:
                return
            after = TRANSITIONS.get((self._status, event))
            if after is None:
                raise RCLError(
                    f"goal_handle attempted invalid transition from state {STATUS_NAMES[self._status]} "
                    f"with event {event.name}"
                )
            self._status = after
            if after in ENDED:
                self._ended_ns = self._action_server._graph.now_ns
            self._action_server._publish_status()


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Executes the goal."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accepts every goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: Any) -> CancelResponse:
    """Refuses to cancel."""
    return CancelResponse.REJECT


class ActionServer:
    """Serves an action: accepts goals, and executes each by ``execute_callback(goal_handle) -> result``.

    Every callback may be a coroutine. The callbacks for goals, cancellations and result requests obey
    ``callback_group``; the execute callback belongs to no group, and so may overlap with all others in a
    MultiThreadedExecutor. Results are kept for ``result_timeout`` seconds after the goal has ended.

    Raises TypeError for a wrong type or callback, InvalidTopicNameException.
    """

    # So that annotations such as ActionServer[Fibonacci] work, as with rclpy's generic classes.
    __class_getitem__: Any = classmethod(GenericAlias)

    def __init__(
        self,
        node: Node,
        action_type: type[Action],
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], Any] | None = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None = default_handle_accepted_callback,
        cancel_callback: Callable[[ServerGoalHandle], Any] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = FEEDBACK_QOS_PROFILE,
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 10,
    ) -> None:
        check_action_type(action_type)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        self.action_type = action_type
        self.action_name = node.resolve_topic_name(action_name)
        """Absolute, after remapping."""
        self._node = node
        self._graph = node.handle.graph
        self._logger = node.get_logger().get_child("action_server")
        self._group = callback_group or node.default_callback_group
        self._result_timeout_ns = int(result_timeout * S_TO_NS)
        self._goals: dict[bytes, ServerGoalHandle] = {}
        self._destroyed = False
        impl = action_type.Impl
        self._services = [
            self._make_service(impl.SendGoalService, SEND_GOAL, self._on_goal, goal_service_qos_profile),
            self._make_service(
                impl.CancelGoalService, CANCEL_GOAL, self._on_cancel, cancel_service_qos_profile
            ),
            self._make_service(
                impl.GetResultService, GET_RESULT, self._on_result_request, result_service_qos_profile
            ),
        ]
        self._feedback_publisher = node.create_publisher(
            impl.FeedbackMessage,
            f"{self.action_name}/{FEEDBACK}",
            feedback_pub_qos_profile,
        )
        self._status_publisher = node.create_publisher(
            impl.GoalStatusMessage, f"{self.action_name}/{STATUS}", status_pub_qos_profile
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def __repr__(self) -> str:
        return f"<action server {self.action_name}>"

    # Callbacks

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Sets what is called with each accepted goal; None: the goal is executed."""
        self._handle_accepted_callback = _checked(
            handle_accepted_callback, default_handle_accepted_callback, "handle accepted callback"
        )

    def register_goal_callback(self, goal_callback: Callable[[Any], Any] | None) -> None:
        """Sets what decides about each goal's message; None: all goals are accepted."""
        self._goal_callback = _checked(goal_callback, default_goal_callback, "goal callback")

    def register_cancel_callback(self, cancel_callback: Callable[[ServerGoalHandle], Any] | None) -> None:
        """Sets the function that decides about requests to cancel a goal; None: they are refused."""
        self._cancel_callback = _checked(cancel_callback, default_cancel_callback, "cancel callback")

    def register_execute_callback(self, execute_callback: Callable[[ServerGoalHandle], Any]) -> None:
        """Sets what executes goals. Raises TypeError."""
        self._execute_callback = _checked(execute_callback, execute_callback, "execute callback")

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Schedules the execute callback for a goal where the node's callbacks run."""
        task: Task[Any] = Task(self._execute_goal, (execute_callback or self._execute_callback, goal_handle))
        task.set_owner(self._node.handle)
        self._node.handle.ready_queue.put(task)

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publishes requests and responses of the action's services on their ``_service_event`` topics."""
        for service in self._services:
            service.configure_introspection(clock, service_event_qos_profile, introspection_state)

    def destroy(self) -> None:
        """Removes the server from the graph. Goals that are being executed have no effect any more."""
        if self._destroyed:
            return
        self._destroyed = True
        with self._graph.lock:
            for goal in self._goals.values():
                goal.destroy()
            self._goals.clear()
        for service in self._services:
            service.destroy()
        self._feedback_publisher.destroy()
        self._status_publisher.destroy()

    # Requests

    def _make_service(
        self, srv_type: type[Any], name: str, callback: Callable[[Any, Respond], Any], profile: QoSProfile
    ) -> DeferredService:
        handle = self._node.handle
        full_name = self._node.resolve_service_name(f"{self.action_name}/{name}")
        service = DeferredService(handle, srv_type, full_name, callback, self._group, profile)
        register_entity(handle.services, service)
        return service

    async def _on_goal(self, request: Any, respond: Respond) -> None:
        key = uuid_bytes(request.goal_id)
        with self._graph.lock:
            self._forget_old_goals()
            is_known = key in self._goals
        goal = None
        response = self.action_type.Impl.SendGoalService.Response()
        if not is_known and await self._is_acceptable(request.goal):
            info = GoalInfo(goal_id=request.goal_id, stamp=self._node.get_clock().now().to_msg())
            goal = ServerGoalHandle(self, info, request.goal)
            with self._graph.lock:
                self._goals[key] = goal
            response.accepted, response.stamp = True, info.stamp
        outcome = f"goal {key.hex()} {'rejected' if goal is None else 'accepted'}"
        self._logger.debug(outcome)
        respond(response)
        if goal is not None:
            await await_or_execute(self._handle_accepted_callback, goal)

    async def _is_acceptable(self, goal_request: Any) -> bool:
        answer = await await_or_execute(self._goal_callback, goal_request)
        if not isinstance(answer, GoalResponse):
            warning = (
                "Goal request callback did not return a GoalResponse type. Rejecting goal. "
                f"(It returned {answer!r}; end it with 'return GoalResponse.ACCEPT')"
            )
            self._logger.warning(warning)
        return answer is GoalResponse.ACCEPT

    async def _on_cancel(self, request: CancelGoal.Request, respond: Respond) -> None:
        with self._graph.lock:
            self._forget_old_goals()
            goals, return_code = self._find_goals_to_cancel(request.goal_info)
        response = CancelGoal.Response(return_code=return_code)
        for goal in goals:
            answer = await await_or_execute(self._cancel_callback, goal)
            if answer is not CancelResponse.ACCEPT:
                response.return_code = CancelGoal.Response.ERROR_REJECTED
                continue
            try:
                goal._update_state(GoalEvent.CANCEL_GOAL)
            except RCLError:  # it has ended while the callback thought about it
                response.return_code = CancelGoal.Response.ERROR_GOAL_TERMINATED
            else:
                response.goals_canceling.append(goal._goal_info)
        if response.goals_canceling:
            response.return_code = CancelGoal.Response.ERROR_NONE
        respond(response)

    def _find_goals_to_cancel(self, wanted: GoalInfo) -> tuple[list[ServerGoalHandle], int]:
        """The goals that a cancel request means, and its return code if there are none.

        An identifier of zeros means every goal, a time every goal accepted until then; neither means all.
        """
        key, until_ns = uuid_bytes(wanted.goal_id), _nanoseconds(wanted.stamp)
        if any(key) and until_ns == 0:
            goal = self._goals.get(key)
            if goal is None:
                return [], CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
            if not _is_cancelable(goal):
                return [], CancelGoal.Response.ERROR_GOAL_TERMINATED
            return [goal], CancelGoal.Response.ERROR_NONE
        found = [
            goal
            for goal_key, goal in self._goals.items()
            if _is_cancelable(goal)
            and (until_ns == 0 or goal_key == key or _nanoseconds(goal._goal_info.stamp) <= until_ns)
        ]
        return found, CancelGoal.Response.ERROR_NONE

    def _on_result_request(self, request: Any, respond: Respond) -> None:
        with self._graph.lock:
            self._forget_old_goals()
            goal = self._goals.get(uuid_bytes(request.goal_id))
        if goal is None:
            respond(self.action_type.Impl.GetResultService.Response(status=GoalStatus.STATUS_UNKNOWN))
            return
        future = goal._result_future
        future.call_when_done(lambda: respond(future.result()))

    # Goals

    async def _execute_goal(
        self, execute_callback: Callable[[ServerGoalHandle], Any], goal: ServerGoalHandle
    ) -> None:
        try:
            result = await await_or_execute(execute_callback, goal)
        except Exception as problem:  # noqa: BLE001  # whatever it raises ends the goal and not the node, as in rclpy
            result = self.action_type.Result()
            error = f"Error raised in execute callback: {problem}"
            self._logger.error(error)
            traceback.print_exc()
        if goal.is_active:
            warning = (
                f"Goal state not set, assuming aborted. Goal ID: {uuid_bytes(goal.goal_id).hex()} "
                "(call goal_handle.succeed() before the execute callback returns)"
            )
            self._logger.warning(warning)
            goal.abort()
        if not goal._result_future.done():
            self._set_result(goal, result)

    def _set_result(self, goal: ServerGoalHandle, result: Any) -> None:
        """Answers the requests for a goal's result. Raises TypeError if it is none of this action's."""
        result_type = self.action_type.Result
        is_result = isinstance(result, result_type)
        response = self.action_type.Impl.GetResultService.Response(
            status=goal.status, result=result if is_result else result_type()
        )
        goal._result_future.set_result(response)
        if not is_result:
            hint = ": end it with 'return result'" if result is None else ""
            raise TypeError(
                f"the execute callback of action '{self.action_name}' must return its result, "
                f"a {self.action_type.__name__}.Result, not {type(result).__name__}{hint}"
            )

    def _forget_old_goals(self) -> None:
        """Forgets goals whose results have been kept long enough. The graph's lock must be held."""
        if self._result_timeout_ns < 0:
            return
        now = self._graph.now_ns
        for key, goal in list(self._goals.items()):
            ended_ns = goal._ended_ns
            if (
                ended_ns is not None
                and now - ended_ns >= self._result_timeout_ns
                and goal._result_future.done()
            ):
                goal.destroy()
                del self._goals[key]

    def _publish_feedback(self, goal_id: UUID, feedback: Any) -> None:
        message = self.action_type.Impl.FeedbackMessage(goal_id=goal_id, feedback=feedback)
        self._feedback_publisher.publish(message)

    def _publish_status(self) -> None:
        """Publishes the states of all goals. With the graph's lock held."""
        self._forget_old_goals()
        self._status_publisher.publish(
            GoalStatusArray(
                status_list=[
                    GoalStatus(goal_info=goal._goal_info, status=goal._status)
                    for goal in self._goals.values()
                ]
            )
        )


def _checked(callback: Any, default: Any, what: str) -> Any:
    """The callback, or the default if there is none. Raises TypeError if it cannot be called with one argument."""
    chosen = default if callback is None else callback
    accepted_argument_count(chosen, (1,), f"an action server, its {what},")
    return chosen


def _is_cancelable(goal: ServerGoalHandle) -> bool:
    return (goal._status, GoalEvent.CANCEL_GOAL) in TRANSITIONS


def _nanoseconds(stamp: Any) -> int:
    return int(stamp.sec) * S_TO_NS + int(stamp.nanosec)
