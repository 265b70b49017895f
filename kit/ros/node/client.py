"""Clients: they call services."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from kit.msg.message import Service as Definition
from kit.ros.exceptions import ExternalShutdownException, ServerGoneError, WouldDeadlock
from kit.ros.execution.callback_groups import NO_WORK, CallbackGroup, MutuallyExclusiveCallbackGroup
from kit.ros.execution.task import Future
from kit.ros.node.endpoint import CallbackEntity, EntityOwner
from kit.ros.node.qos import QoSProfile
from kit.ros.node.service import Call
from kit.ros.node.service_introspection import (
    ServiceEventKind,
    ServiceEventPublisher,
    ServiceIntrospectionState,
)
from kit.ros.node.time import S_TO_NS

if TYPE_CHECKING:
    from kit.ros.node.clock import Clock

Request = TypeVar("Request")
Response = TypeVar("Response")


_WARN_AFTER_NS = S_TO_NS
"""How long a blocking call waits before it warns that no thread may be spinning its node."""


class Client(CallbackEntity, Generic[Request, Response]):
    """Calls a service. ``Node.create_client`` makes one."""

    def __init__(
        self,
        handle: EntityOwner,
        srv_type: type[Definition],
        srv_name: str,
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        self._handle = handle
        self._graph = handle.graph
        self.srv_type = srv_type
        self.service_name = srv_name
        """Absolute, after remapping."""
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self.number = self._graph.next_number()
        self._introspection = ServiceEventPublisher(self)
        self._last_number = 0
        self._pending: dict[int, Future[Any]] = {}
        self._losses = 0
        """How often the last server has gone while calls waited."""
        self._queue: deque[tuple[int, Any]] = deque()
        with self._graph.lock:
            self._graph.directory.add_client(self)

    def __repr__(self) -> str:
        return f"client of {self.service_name}"

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
        """Publishes its requests and their responses on ``<service>/_service_event``, or stops that."""
        self._introspection.configure(clock, service_event_qos_profile, introspection_state)

    def call(self, request: Request, timeout_sec: float | None = None) -> Response | None:
        """Sends a request and waits for the response; another thread must spin the node meanwhile.

        Raises TypeError for a wrong request, TimeoutError, and WouldDeadlock in a callback that the response
        would have to wait for.
        """
        self._check(request)
        what = f"call() on '{self.service_name}'"
        self.raise_if_deadlock(what, "call_async()")
        future = self.call_async(request)
        self.wait_until_done(future, what, "call_async()", timeout_sec)
        return future.result()

    def wait_until_done(
        self, future: Future[Any], what: str, instead: str, timeout_sec: float | None = None
    ) -> None:
        """Waits for a future that depends on this client's responses; another thread must spin the node.

        ``what`` names the waiting call in messages, ``instead`` the one that does not wait. Raises TimeoutError,
        ServerGoneError, ExternalShutdownException.
        """
        future.call_when_done(self._graph.notify)
        context, now = self._handle.context, self._graph.now_ns
        until = None if timeout_sec is None or timeout_sec < 0 else now + int(timeout_sec * S_TO_NS)
        losses = self._losses

        def is_over() -> bool:
            return future.done() or not context.ok() or self._losses != losses

        first = now + _WARN_AFTER_NS if until is None else min(until, now + _WARN_AFTER_NS)
        if not self._graph.wait(is_over, first, what=what) and not self._handle.is_spun:
            warning = (
                f"{what} waits until another thread spins this node; if none does, it waits forever. "
                f"Without threads: {instead}, then rclpy.spin_until_future_complete()"
            )
            self._handle.logger.warning(warning)
        self._graph.wait(is_over, until, what=what)
        if not future.done():
            self.remove_pending_request(future)
            if not context.ok():
                raise ExternalShutdownException
            if self._losses != losses:
                raise ServerGoneError(f"{what}: {self._server_gone_text(1)}")
            raise TimeoutError(f"service '{self.service_name}' did not answer within {timeout_sec} s")

    def call_async(self, request: Request) -> Future[Response]:
        """Sends a request; the future gets the response when this node's callbacks run."""
        self._check_not_destroyed()
        self._check(request)
        future: Future[Response] = Future()
        future.set_owner(self._handle, self.callback_group)
        graph = self._graph
        with graph.lock:
            self._last_number += 1
            self._pending[self._last_number] = future
            if graph.message_listeners:
                graph.notify_message_listeners(self._handle.node, self.service_name, request)
            self._introspection.publish(
                ServiceEventKind.REQUEST_SENT,
                self,
                self._last_number,
                request,  # type: ignore[arg-type]  # a message
            )
            server = graph.directory.find_server(self.service_name, self.srv_type)
            if server is not None:
                server.enqueue(Call(self, self._last_number, request.__deepcopy__(None)))  # type: ignore[attr-defined]  # a message
                graph.notify()
        if server is None:
            self.remove_pending_request(future)
            self._handle.logger.warning(self._no_server_text())
        return future

    @property
    def pending_count(self) -> int:
        """The number of calls whose answers may still come."""
        return len(self._pending)

    def report_lost_server(self) -> None:
        """Warns that the last server has gone, if calls wait for its answers. With the graph's lock held."""
        answered = {number for number, _ in self._queue}
        lost = self._pending.keys() - answered
        if lost:
            self._pending = {number: self._pending[number] for number in answered if number in self._pending}
            self._losses += 1
            self._handle.logger.warning(self._server_gone_text(len(lost)))
            self._graph.notify()

    def _no_server_text(self) -> str:
        return f"no node serves '{self.service_name}': this call will never be answered; wait_for_service() first"

    def _server_gone_text(self, waiting: int) -> str:
        calls = "the call" if waiting == 1 else f"{waiting} calls"
        return f"the node that served '{self.service_name}' has gone: {calls} will never be answered"

    def remove_pending_request(self, future: Future[Response]) -> None:
        """Forgets a call; its response will be dropped."""
        with self._graph.lock:
            self._pending = {number: other for number, other in self._pending.items() if other is not future}

    def service_is_ready(self) -> bool:
        """True if a node serves it."""
        self._graph.count_read()
        return self._graph.directory.find_server(self.service_name, self.srv_type) is not None

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Waits until a node serves it; True if one does."""
        until = (
            None
            if timeout_sec is None or timeout_sec < 0
            else self._graph.now_ns + int(timeout_sec * S_TO_NS)
        )
        context = self._handle.context
        self._graph.wait(
            lambda: self.service_is_ready() or not context.ok(),
            until,
            what=f"wait_for_service() on '{self.service_name}', which no node serves,",
        )
        return self.service_is_ready()

    def enqueue(self, number: int, response: Any) -> None:
        """Queues a response. With the graph's lock held."""
        if not self._destroyed:
            self._queue.append((number, response))
            self._handle.ready_queue.items.append(self)

    def take(self) -> Any:
        return self._queue.popleft() if self._queue else NO_WORK

    def run(self, taken: tuple[int, Any]) -> Any:
        number, response = taken
        self._introspection.publish(ServiceEventKind.RESPONSE_RECEIVED, self, number, response)
        future = self._pending.pop(number, None)
        if future is not None and not future.done():
            future.set_result(response)

    def discard_queue(self) -> None:
        self._queue.clear()

    def _unregister(self) -> None:
        self._queue.clear()
        self._pending.clear()
        self._introspection.destroy()
        self._graph.directory.remove_client(self)

    def _check(self, request: Any) -> None:
        if not isinstance(request, self.srv_type.Request):
            hint = f"; write {self.srv_type.__name__}.Request()" if request is self.srv_type.Request else ""
            raise TypeError(
                f"Expected {self.srv_type.__name__}.Request, got {type(request)}, to call '{self.service_name}'{hint}"
            )

    def raise_if_unserved(self, what: str) -> None:
        """Raises ServerGoneError if no node serves it, so that the answer would never come."""
        if not self.service_is_ready():
            raise ServerGoneError(f"{what}: {self._no_server_text()}")

    def raise_if_deadlock(self, what: str, instead: str) -> None:
        """Raises WouldDeadlock if the response, which is a callback too, would have to wait for the calling callback."""
        work = self._graph.thread_state.work
        if work is None or work[0] is not self._handle.ready_queue:
            return
        ready_queue, item = work
        group = self.callback_group
        blocked = isinstance(group, MutuallyExclusiveCallbackGroup) and group.active is item
        if ready_queue.is_exclusive or blocked:
            raise WouldDeadlock(
                f"{what} inside a callback would wait forever: the response is handled by "
                f"the same executor, which waits for this callback to return. Use {instead} and either "
                "add_done_callback() or 'await' in an async callback; or a MultiThreadedExecutor, with the client in "
                "a callback group of its own."
            )
