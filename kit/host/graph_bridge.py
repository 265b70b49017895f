"""Bridges a graph across two processes: both ends.

Each end runs its own nodes, keeps proxies of the other end's (``kit.host.proxy_nodes``), and exchanges events with it.
So what is written for one graph works across two processes: a student's node beside the kit, a second terminal
beside a running world. The end with the world's time is the parent, the other one the child.

Messages, requests and responses name an endpoint of the child's, whichever way they go.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

from kit.host.codec import Codec, NotFiniteError
from kit.host.proxy_nodes import GraphDiff, NameScope, ProxyClient, ProxyNodes
from kit.host.waiter import AllThreadsWaiter, TickSource
from kit.host.wire import Json, ProtocolError, integer, items, memory_size
from kit.msg.message import Message, is_request_or_response
from kit.ros.graph.directory import Excess, NodeLike
from kit.ros.graph.graph import Graph, Waiter
from kit.ros.node.publisher import Publisher
from kit.ros.node.service import Call, Service

if TYPE_CHECKING:
    from kit.host.protocol import (
        GraphEvent,
    )  # read by the parent alone: it would take a seventh of a child's start

INTERRUPT: Final = "interrupt"
"""The event by which the parent asks a program to end, as Ctrl-C does."""
INTERRUPTED: Final = "interrupted"
"""The event by which a program tells that it has ended by that, without catching KeyboardInterrupt."""
SHORTEST_STEP_NS: Final = 100_000
"""The least by which a child's time advances within a tick [ns]."""
MAX_OVERDUE_NS: Final = 100_000_000
"""Who was to wake longer ago than that, because the program was too slow for real time, wakes at the tick's time [ns]."""

LAUNCH_CHANNEL: Final = "launch"
"""The kind of event by which a test for launch_testing requests what a launch file does, and hears what happens."""
LAUNCH_OVER: Final = "over"
"""The last of what it hears: every process has ended."""


class PendingEvent(NamedTuple):
    """An event that the other end has not been sent yet, and the time at which it happened [ns]."""

    time_ns: int
    event: list[Json]


class GraphBridge(ABC):
    """One end of a bridge: keeps proxies of the other end's nodes, and the events that wait to be sent."""

    def __init__(
        self, graph: Graph, *, in_child: bool, shares_interfaces: bool, scope: NameScope | None = None
    ) -> None:
        """``shares_interfaces``: sends and takes the definitions of interfaces that are not the kit's own. ``scope``: the
        names that the other end may use, by default all."""
        self.graph = graph
        self.pending: list[PendingEvent] = []
        """Messages, requests and responses for the other end, oldest first."""
        self._codec = Codec(in_child=in_child)
        self._proxies = ProxyNodes(
            graph, self, allow_unknown_types=in_child, shares_interfaces=shares_interfaces, scope=scope
        )
        self._diff = GraphDiff(graph, self._proxies, shares_interfaces=shares_interfaces)
        self._handlers: dict[str, Callable[[list[Json]], None]] = {
            "message": self._apply_message,
            "request": self._apply_request,
            "response": self._apply_response,
        }

    @property
    def node_names(self) -> frozenset[str]:
        """The full names of the other end's nodes."""
        return self._proxies.node_names

    @property
    def has_pending(self) -> bool:
        """Whether there is something to send."""
        return bool(self.pending) or self._diff.has_changed

    def open_channel(self, name: str, apply: Callable[[list[Json]], object]) -> Callable[..., None]:
        """Adds a kind of event to those of the graph: ``apply`` is called with the fields of each that comes, the function that
        is returned sends one."""

        def apply_fields(fields: list[Json]) -> None:
            apply(fields)

        self._handlers[name] = apply_fields
        return partial(self._add, name)

    def take_changes(self) -> list[Json]:
        """Returns the events for what has changed among this end's own nodes since the last call."""
        return self._diff.take_changes()

    def take_pending(self) -> list[Json]:
        """Removes and returns all events to be sent."""
        pending, self.pending = self.pending, []
        return [*self.take_changes(), *(event for _, event in pending)]

    def _add(self, *event: Json) -> None:
        self.pending.append(PendingEvent(self.graph.now_ns, list(event)))

    def _apply(self, name: str, fields: list[Json]) -> None:
        """Applies an event of the other end's. Raises ProtocolError."""
        if name in self._handlers:
            self._handlers[name](fields)
            return
        has_changed = self._diff.has_changed
        self._proxies.apply_event(name, fields)
        if not has_changed:
            self._diff.mark_seen()

    # Events of the other end's, and calls of a ProxyListener; how they name endpoints differs between the ends

    @abstractmethod
    def _apply_message(self, fields: list[Json]) -> None: ...

    @abstractmethod
    def _apply_request(self, fields: list[Json]) -> None: ...

    @abstractmethod
    def _apply_response(self, fields: list[Json]) -> None: ...

    @abstractmethod
    def on_message(self, subscription: int, message: Message) -> None: ...

    @abstractmethod
    def on_request(self, service: int, call: Call) -> None: ...

    @abstractmethod
    def on_response(self, client: int, number: int, response: Message) -> None: ...

    @abstractmethod
    def on_discard(self, endpoint: int) -> None: ...


class MessageLimitError(ProtocolError):
    """The child has sent more messages within one tick than it may."""


class KeptLimitError(ProtocolError):
    """More messages are kept for the child than may be."""


class _PendingRequest(NamedTuple):
    """A request to one of the child's services that waits for its response."""

    service: int
    call: Call
    size: int
    """Bytes, about."""


class ParentBridge(GraphBridge):
    """The parent's end: the child's nodes in our graph. What the child sends is checked. Never waits."""

    def __init__(
        self,
        graph: Graph,
        max_messages: int | None = None,
        max_kept: int | None = None,
        *,
        shares_interfaces: bool = False,
        scope: NameScope | None = None,
    ) -> None:
        """``max_messages``: messages, requests and responses that the child may send within one tick; ``max_kept``:
        bytes of messages that are kept for it here; ``scope``: the names that it may use, by default all."""
        super().__init__(graph, in_child=False, shares_interfaces=shares_interfaces, scope=scope)
        self._requests: dict[int, _PendingRequest] = {}
        self._is_publishing = False
        self._max_messages = max_messages
        self._max_kept = max_kept
        self._kept = 0
        """Bytes, about, of ``_histories`` and ``_requests``."""
        self._histories: dict[int, deque[int]] = {}
        """Sizes of the messages that each publisher keeps."""
        self._counted_ns = graph.now_ns
        self._message_count = 0
        self._sent_excesses: set[tuple[str, str, str]] = set()
        self._sent_limits: dict[str, tuple[str, ...]] = {}

    def take_changes(self) -> list[Json]:
        """Returns also what is carried out of commands at most, and who has asked for more: only the world's side knows that."""
        if not self.has_pending:
            return []
        events, excesses = super().take_changes(), self.graph.directory.excesses
        events += [["excess", *key, *excesses[key]] for key in excesses if key not in self._sent_excesses]
        self._sent_excesses.update(excesses)
        limits = self.graph.directory.command_limits
        events += [
            ["limits", topic, list(limits.get(topic, ()))]
            for topic in sorted({*limits, *self._sent_limits})
            if limits.get(topic) != self._sent_limits.get(topic)
        ]
        self._sent_limits = dict(limits)
        return events

    def apply_events(self, events: Sequence[GraphEvent]) -> None:
        """Applies what has happened in the child. Raises ProtocolError, MessageLimitError, KeptLimitError,
        ReservedNameError, ForeignNameError."""
        with self.graph.lock:
            self._count_messages(events)
            for event in events:
                self._apply(event.name, event.fields)
                if self._max_kept is not None and self._kept > self._max_kept:
                    raise KeptLimitError(f"more than {self._max_kept} bytes of messages to be kept")

    def _count_messages(self, events: Sequence[GraphEvent]) -> None:
        if self._max_messages is None:
            return
        if self.graph.now_ns != self._counted_ns:
            self._counted_ns, self._message_count = self.graph.now_ns, 0
        self._message_count += sum(event.name in self._handlers for event in events)
        if self._message_count > self._max_messages:
            raise MessageLimitError(f"more than {self._max_messages} messages in one tick")

    def _count_history(self, publisher: int, length: int | None, size: int) -> None:
        """Counts a message that a publisher keeps, instead of its oldest one where ``length`` are kept already.

        What a publisher has kept that is gone stays counted: a program has no reason to make one after the other.
        """
        history = self._histories.setdefault(publisher, deque())
        if len(history) == length:
            self._kept -= history.popleft()
        history.append(size)
        self._kept += size

    def clear(self) -> None:
        """Removes the child's nodes from the graph."""
        self._proxies.clear()

    def _apply_message(self, fields: list[Json]) -> None:
        identity, content = items(fields, 2)
        publisher = self._proxies.endpoint(identity, Publisher)
        message = self._codec.unpack(publisher.msg_type, content)
        if self._max_kept is not None and publisher.qos_profile.is_transient_local:
            self._count_history(identity, publisher.qos_profile.queue_length, memory_size(content))
        # The child's own subscriptions have received it already.
        self._is_publishing = True
        try:
            publisher.publish_without_copy(message)
        finally:
            self._is_publishing = False

    def _apply_request(self, fields: list[Json]) -> None:
        identity, number, content = items(fields, 3)
        client = self._proxies.endpoint(identity, ProxyClient)
        client.send_request(integer(number), self._codec.unpack(client.srv_type.Request, content))

    def _apply_response(self, fields: list[Json]) -> None:
        identity, number, content = items(fields, 3)
        service = self._proxies.endpoint(identity, Service)
        request = self._requests.pop(integer(number), None)
        if request is None or request.service != identity:
            raise ProtocolError("a response to a request that was not made")
        self._kept -= request.size
        response = self._codec.unpack(service.srv_type.Response, content)
        self.graph.notify_message_listeners(service.handle.node, service.service_name, response)
        request.call.client.enqueue(request.call.number, response)
        self.graph.notify()

    def on_message(self, subscription: int, message: Message) -> None:
        if not self._is_publishing:
            self._add("message", subscription, self._codec.pack(message))

    def on_request(self, service: int, call: Call) -> None:
        number = self.graph.next_number()
        content = self._codec.pack(call.request)
        size = 0 if self._max_kept is None else memory_size(content)
        self._requests[number] = _PendingRequest(service, call, size)
        self._kept += (
            size  # checked in ``apply_events``: this runs in the call of whoever has made the request
        )
        self._add("request", service, number, content)

    def on_response(self, client: int, number: int, response: Message) -> None:
        self._add("response", client, number, self._codec.pack(response))

    def on_discard(self, endpoint: int) -> None:
        self.pending = [pending for pending in self.pending if pending.event[1] != endpoint]


class CommandSource(Protocol):
    """Commands of the parent's, each answered once; ``kit.host.protocol`` lists them."""

    def answer(self, kind: str, *content: Json) -> None:
        """Answers the last command."""

    def next_command(self) -> list[Json]:
        """Waits for the next command; returns its kind and its content."""


class ChildBridge(GraphBridge):
    """The child's end: a graph of its own, whose time and messages come from the parent's."""

    def __init__(
        self,
        commands: CommandSource,
        now_ns: int,
        make_waiter: Callable[[TickSource], Waiter] = AllThreadsWaiter,
        uninterrupted: Callable[[], AbstractContextManager[None]] = nullcontext,
        *,
        shares_interfaces: bool = False,
    ) -> None:
        """``uninterrupted``: makes a context that keeps signals away from an exchange."""
        super().__init__(
            Graph(now_ns, waiter=make_waiter(self)), in_child=True, shares_interfaces=shares_interfaces
        )
        self._commands = commands
        self._uninterrupted = uninterrupted
        self.has_had_nodes = False
        """Whether the program has ever had a node."""
        self.has_ticked = False
        """Whether a tick has come since the start."""
        self._upcoming: tuple[int, list[Json]] | None = None
        """The time [ns] and the events of a tick whose time the program has not reached yet."""
        self.graph.add_message_listener(self._record_message)
        self._handlers["excess"] = self._apply_excess
        self._handlers["limits"] = self._apply_limits
        self._handlers[INTERRUPT] = self._apply_interrupt
        self.on_interrupt: Callable[[], object] = lambda: None
        """Called when the parent asks the program to end, as Ctrl-C does."""

    def next_tick(self, wake_ns: int | None) -> None:
        """Answers that the program waits, until ``wake_ns`` at the latest, and applies the next tick.

        If that is earlier than the tick, only the time advances, and only so far: who waits for less than a tick, or for
        what is no multiple of it, goes on at the time for which it waits.
        """
        tick_ns, _ = self._upcoming or self._exchange("reply", wake_ns)
        now_ns = self.graph.now_ns
        if wake_ns is not None and now_ns + 1 < wake_ns and tick_ns - wake_ns <= MAX_OVERDUE_NS:
            next_ns = max(wake_ns, now_ns + SHORTEST_STEP_NS)
            if next_ns < tick_ns:
                self.graph.advance(next_ns)
                return
        self._apply_tick()

    def next_held_tick(self) -> None:
        """Likewise, at once; simulated time is to stand still from that tick until the next answer."""
        self._apply_tick()
        self._exchange("held")
        self._apply_tick()

    def _exchange(self, kind: str, *wake_ns: int | None) -> tuple[int, list[Json]]:
        with self._uninterrupted():
            self._commands.answer(kind, *wake_ns, self._flush())
            _, now_ns, events = self._commands.next_command()
            self._upcoming = now_ns, events
            self.has_ticked = True
            return self._upcoming

    def _apply_tick(self) -> None:
        if self._upcoming is not None:
            with self._uninterrupted(), self.graph.lock:
                now_ns, events = self._upcoming
                self._upcoming = None
                self.graph.advance(now_ns)
                self.apply_events(events)

    def leave(self) -> None:
        """Forgets what was under way in a process of which this one is a fork: its threads, and what was to be sent."""
        self.graph.waiting_threads.clear()
        self.pending.clear()
        self._upcoming = None

    def send_last_messages(self) -> None:
        """Sends what a program has published before it failed: in an answer of its own, since a failure has no events."""
        if self.has_ticked and self.pending and not self.graph.is_waiter_running:
            self._apply_tick()
            self.next_tick(self.graph.now_ns + 1)

    def end(self, *, by_interrupt: bool = False) -> None:
        """Answers that the program has ended. ``by_interrupt``: by the KeyboardInterrupt of a request to end."""
        if by_interrupt:
            self._add(INTERRUPTED)
        with self._uninterrupted():
            self._commands.answer("ended", self._flush())

    def apply_events(self, events: list[Json]) -> None:
        """Applies what has happened in the parent."""
        with self.graph.lock:
            for name, *fields in events:
                self._apply(name, fields)
            self.graph.notify()

    def _flush(self) -> list[Json]:
        with self.graph.lock:
            self._add_changes()
            return self.take_pending()

    def _add_changes(self) -> None:
        """Queues changes before what follows from them: a message of a new publisher, say."""
        for event in self.take_changes():
            self.has_had_nodes = True
            self._add(*event)

    def _record_message(self, _: int, node: NodeLike, topic: str, message: Message) -> None:
        """Queues every message of the program's own nodes, whether or not anything subscribes."""
        if not is_request_or_response(type(message)):
            self._add_changes()
            number = self._diff.publisher_number(node.handle, topic, type(message))
            try:
                content = self._codec.pack(message)
            except NotFiniteError as problem:
                raise ValueError(
                    f"{problem} of the {type(message).__name__} for {topic} is not a finite number. "
                    "(A laser ray that meets nothing reads nan or inf.)"
                ) from None
            self._add("message", number, content)

    def on_message(self, subscription: int, message: Message) -> None:
        """Does nothing: ``_record_message`` has queued the message."""

    def on_request(self, service: int, call: Call) -> None:
        self._add_changes()
        self._add("request", call.client.number, call.number, self._codec.pack(call.request))

    def on_response(self, client: int, number: int, response: Message) -> None:
        raise AssertionError("responses to the parent's clients go through _ParentClient")

    def on_discard(self, endpoint: int) -> None:
        """Does nothing: nothing is queued for the parent's subscriptions."""

    def _apply_message(self, fields: list[Json]) -> None:
        number, content = fields
        subscription: Any = self._diff.endpoints.get(number)
        if subscription is not None:  # it may have been destroyed since
            subscription.enqueue(self._codec.unpack(subscription.msg_type, content))

    def _apply_excess(self, fields: list[Json]) -> None:
        node, topic, field, *excess = map(str, fields)
        self.graph.directory.note_excess(node, topic, field, Excess(*excess))

    def _apply_interrupt(self, fields: list[Json]) -> None:
        self.on_interrupt()

    def _apply_limits(self, fields: list[Json]) -> None:
        topic, most = fields
        self.graph.directory.note_command_limits(topic, tuple(most))

    def _apply_request(self, fields: list[Json]) -> None:
        identity, number, content = fields
        service: Any = self._diff.endpoints.get(identity)
        if service is not None:
            client: Any = _ParentClient(self, identity)
            service.enqueue(Call(client, number, self._codec.unpack(service.srv_type.Request, content)))

    def _apply_response(self, fields: list[Json]) -> None:
        identity, number, content = fields
        client: Any = self._diff.endpoints.get(identity)
        if client is not None:
            client.enqueue(number, self._codec.unpack(client.srv_type.Response, content))

    def send_response(self, service: int, number: int, response: Message) -> None:
        """Queues the response of one of the program's services to a client of the parent's."""
        self._add("response", service, number, self._codec.pack(response))


class _ParentClient:
    """The client of a call that came from the parent: passes the response on."""

    def __init__(self, bridge: ChildBridge, service: int) -> None:
        self._bridge = bridge
        self._service = service

    def enqueue(self, number: int, response: Message) -> None:
        self._bridge.send_response(self._service, number, response)
