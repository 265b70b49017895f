"""How often and how fast messages flow on each topic, and the last values of a field."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, NamedTuple

from kit.msg.conversion import FieldValue, field_values
from kit.msg.message import Message, type_name
from kit.ros.graph.directory import (
    NodeLike,
)

if TYPE_CHECKING:
    from kit.ros.graph.graph import Graph


RATE_WINDOW: Final = 50
"""Number of messages over which a rate is averaged."""

SILENT_AFTER: Final = 3.0
"""A flow is silent after this many of its own periods, or after this many seconds if that is longer."""


class MessageFlow(NamedTuple):
    """The messages of one node on one topic or service."""

    node: str
    """Full name of the node."""
    name: str
    """Name of the topic or service."""
    is_service: bool = False
    response_to: str | None = None
    """For the responses of a service: the node that sent the request."""


@dataclass(frozen=True, slots=True)
class FlowStats:
    """Number and rate of the messages of a flow."""

    count: int
    rate: float | None
    """Messages per second of the graph's time; None while it is silent or too new."""


@dataclass(slots=True)
class _FlowCounter:
    count: int = 0
    times: deque[int] = field(default_factory=lambda: deque(maxlen=RATE_WINDOW))
    """Times of the last messages [ns]."""

    def add(self, time_ns: int) -> None:
        times = self.times
        if times and time_ns < times[-1]:  # time has jumped back
            times.clear()
        self.count += 1
        times.append(time_ns)

    def rate(self, now_ns: int) -> float | None:
        times = self.times
        if len(times) < 2 or times[-1] == times[0]:
            return None
        period = (times[-1] - times[0]) / (len(times) - 1)
        if not 0 <= now_ns - times[-1] <= max(SILENT_AFTER * period, SILENT_AFTER * 1e9):
            return None
        return 1e9 / period


HISTORY: Final = 300
"""Messages of the selected topic whose numbers are kept."""


class FieldSample(NamedTuple):
    """The numbers of one message."""

    time_ns: int
    """When it was published, in the graph's time [ns]."""
    values: Mapping[str, FieldValue]
    """Values by path, as ``kit.msg.conversion`` names them."""


class TopicStats:
    """Counts the messages of a graph until ``stop()``. May be read from any thread."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self._counters: dict[MessageFlow, _FlowCounter] = {}
        self._requesters: dict[str, deque[str]] = {}
        self._selected: str | None = None
        self._latest_message: Message | None = None
        self._history: deque[FieldSample] = deque(maxlen=HISTORY)
        self.stop = graph.add_message_listener(self._count_message)

    def select(self, name: str | None) -> None:
        """Chooses the topic or service whose latest message and history are kept."""
        with self.graph.lock:
            if name != self._selected:
                self._selected, self._latest_message = name, None
                self._history.clear()

    @property
    def latest_message(self) -> Message | None:
        """The latest message of the selected topic, request or response of the service, since it was selected: a
        copy, not to be changed."""
        return self._latest_message

    def history(self) -> tuple[FieldSample, ...]:
        """The numbers of the last ``HISTORY`` messages of the selected topic since it was selected, oldest first.
        A reset of the time starts it again."""
        with self.graph.lock:
            return tuple(self._history)

    def flow_stats(self) -> Mapping[MessageFlow, FlowStats]:
        """Number and rate of all flows since the beginning."""
        with self.graph.lock:
            now = self.graph.now_ns
            return MappingProxyType(
                {
                    flow: FlowStats(counter.count, counter.rate(now))
                    for flow, counter in self._counters.items()
                }
            )

    def _count_message(self, time_ns: int, node: NodeLike, name: str, message: Message) -> None:
        """Called for every message with the graph's lock held, so it must be quick."""
        flow = self._make_flow(node.handle.full_name, name, type_name(type(message)))
        counter = self._counters.get(flow)
        if counter is None:
            counter = self._counters[flow] = _FlowCounter()
        counter.add(time_ns)
        if name == self._selected:
            self._latest_message = message.__deepcopy__(None)
            if self._history and time_ns < self._history[-1].time_ns:  # time has jumped back
                self._history.clear()
            self._history.append(FieldSample(time_ns, field_values(message)))

    def _make_flow(self, sender: str, name: str, kind: str) -> MessageFlow:
        if kind.endswith("_Request"):
            self._requesters.setdefault(name, deque(maxlen=RATE_WINDOW)).append(sender)
            return MessageFlow(sender, name, is_service=True)
        if kind.endswith("_Response"):
            waiting = self._requesters.get(name)
            return MessageFlow(
                sender, name, is_service=True, response_to=waiting.popleft() if waiting else None
            )
        return MessageFlow(sender, name)
