"""Services: they answer requests by their callback."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from types import CoroutineType
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from kit.msg.message import Service as Definition
from kit.ros.execution.callback_groups import NO_WORK, CallbackGroup
from kit.ros.graph.directory import ServiceClient
from kit.ros.node.endpoint import CallbackEntity, EntityOwner, accepted_argument_count
from kit.ros.node.qos import QoSProfile
from kit.ros.node.service_introspection import (
    ServiceEventKind,
    ServiceEventPublisher,
    ServiceIntrospectionState,
)

if TYPE_CHECKING:
    from kit.ros.node.clock import Clock

Request = TypeVar("Request")
Response = TypeVar("Response")


class Call(NamedTuple):
    """A request that a client sent, with the number by which the client finds its future."""

    client: ServiceClient
    number: int
    request: Any


class Service(CallbackEntity, Generic[Request, Response]):
    """Answers requests. ``Node.create_service`` makes one.

    The callback ``(request, response) -> response`` may be a coroutine: then the response is sent later.
    """

    def __init__(
        self,
        handle: EntityOwner,
        srv_type: type[Definition],
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        self._handle = handle
        self._graph = handle.graph
        self.srv_type = srv_type
        self.service_name = srv_name
        """Absolute, after remapping."""
        self.callback = callback
        accepted_argument_count(callback, (2,), f"the service {srv_name}")
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self.number = self._graph.next_number()
        self._introspection = ServiceEventPublisher(self)
        self._queue: deque[Call] = deque()
        with self._graph.lock:
            self._graph.directory.add_service(self)

    def __repr__(self) -> str:
        return f"service {self.service_name}"

    __str__ = __repr__

    @property
    def srv_name(self) -> str:
        return self.service_name

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publishes its requests and responses on ``<service>/_service_event``, or stops that."""
        self._introspection.configure(clock, service_event_qos_profile, introspection_state)

    def enqueue(self, call: Call) -> None:
        """Queues a request. With the graph's lock held."""
        self._queue.append(call)
        self._handle.ready_queue.items.append(self)

    def take(self) -> Any:
        return self._queue.popleft() if self._queue else NO_WORK

    def run(self, taken: Call) -> Any:
        self._introspection.publish(
            ServiceEventKind.REQUEST_RECEIVED, taken.client, taken.number, taken.request
        )
        return self._answer(taken)

    def _answer(self, call: Call) -> Any:
        """Calls the callback for a request; returns a coroutine if the callback is one."""
        response = self.callback(call.request, self.srv_type.Response())
        if type(response) is CoroutineType:
            return self._respond_later(call, response)
        self.respond(call, response)
        return None

    async def _respond_later(self, call: Call, response: CoroutineType[Any, Any, Any]) -> None:
        self.respond(call, await response)

    def respond(self, call: Call, response: Any) -> None:
        """Sends the response to a call. Raises TypeError if it is none of this service's."""
        if not isinstance(response, self.srv_type.Response):
            hint = ": end it with 'return response'" if response is None else ""
            raise TypeError(
                f"the callback of service '{self.service_name}' must return its response, "
                f"a {self.srv_type.__name__}.Response, not {type(response).__name__}{hint}"
            )
        graph = self._graph
        with graph.lock:
            if graph.message_listeners:
                graph.notify_message_listeners(self._handle.node, self.service_name, response)
            self._introspection.publish(ServiceEventKind.RESPONSE_SENT, call.client, call.number, response)
            call.client.enqueue(call.number, response.__deepcopy__(None))
            graph.notify()

    def discard_queue(self) -> None:
        self._queue.clear()

    def _unregister(self) -> None:
        self._queue.clear()
        self._introspection.destroy()
        self._graph.directory.remove_service(self)


class DeferredService(Service[Any, Any]):
    """A service whose callback ``(request, respond)`` answers by ``respond(response)``, at once or later.

    Unlike a coroutine that awaits, a request that waits for its answer does not occupy the callback group.
    """

    def _answer(self, call: Call) -> Any:
        return self.callback(call.request, partial(self._respond_while_there, call))

    def _respond_while_there(self, call: Call, response: Any) -> None:
        if not self._destroyed:
            self.respond(call, response)
