"""Counts the messages of a graph per node and topic, with their rates, and keeps the latest message of one topic."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, NamedTuple

from kit.msg.message import type_name

if TYPE_CHECKING:
    from kit.msg.message import Message
    from kit.ros.graph.directory import GraphNode
    from kit.ros.graph.graph import Graph

RATE_WINDOW: Final = 50
"""Number of messages over which a rate is averaged."""

SILENT_AFTER: Final = 3.0
"""A flow is silent after this many of its own periods, or after so many seconds if that is longer."""


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


class TopicStats:
    """Counts the messages of a graph until ``stop()``. May be read from any thread."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self._counters: dict[MessageFlow, _FlowCounter] = {}
        self._requesters: dict[str, deque[str]] = {}
        self._selected: str | None = None
        self._latest_message: Message | None = None
        self.stop = graph.add_message_listener(self._count_message)

    def select(self, name: str | None) -> None:
        """Chooses the topic or service whose latest message is kept."""
        with self.graph.lock:
            if name != self._selected:
                self._selected, self._latest_message = name, None

    @property
    def latest_message(self) -> Message | None:
        """The latest message of the selected topic, request or response of the service, since it was selected: a
        copy, not to be changed."""
        return self._latest_message

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

    def _count_message(self, time_ns: int, node: GraphNode, name: str, message: Message) -> None:
        """Called for every message with the graph's lock held, so it must be quick."""
        flow = self._flow(node.handle.full_name, name, type_name(type(message)))
        counter = self._counters.get(flow)
        if counter is None:
            counter = self._counters[flow] = _FlowCounter()
        counter.add(time_ns)
        if name == self._selected:
            self._latest_message = message.__deepcopy__(None)

    def _flow(self, sender: str, name: str, kind: str) -> MessageFlow:
        if kind.endswith("_Request"):
            self._requesters.setdefault(name, deque(maxlen=RATE_WINDOW)).append(sender)
            return MessageFlow(sender, name, is_service=True)
        if kind.endswith("_Response"):
            waiting = self._requesters.get(name)
            return MessageFlow(
                sender, name, is_service=True, response_to=waiting.popleft() if waiting else None
            )
        return MessageFlow(sender, name)
