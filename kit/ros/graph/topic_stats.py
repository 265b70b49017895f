"""What is being said in a graph: who says how much on which topic, how often, and the newest message of one topic."""

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
"""Messages over which a rate is taken."""

SILENT_AFTER: Final = 3.0
"""A flow is silent after this many of its own periods, or after so many seconds if that is longer."""


class MessageFlow(NamedTuple):
    """What one node says under one name."""

    node: str
    """Full name."""
    name: str
    """Of the topic or service."""
    is_service: bool = False
    response_to: str | None = None
    """For a service's answers: the node that had asked."""


@dataclass(frozen=True, slots=True)
class FlowStats:
    """How much was said so far."""

    count: int
    rate: float | None
    """Messages per second of the graph's time; None while it is silent, or too new to tell."""


@dataclass(slots=True)
class _FlowCounter:
    count: int = 0
    times: deque[int] = field(default_factory=lambda: deque(maxlen=RATE_WINDOW))
    """When the last messages were sent [ns]."""

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
    """Listens in a graph until ``stop()``. Safe to be asked from any thread."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self._counters: dict[MessageFlow, _FlowCounter] = {}
        self._requesters: dict[str, deque[str]] = {}
        self._selected: str | None = None
        self._latest_message: Message | None = None
        self.stop = graph.add_message_listener(self._count_message)

    def select(self, name: str | None) -> None:
        """The topic or service whose newest message is kept from now on."""
        with self.graph.lock:
            if name != self._selected:
                self._selected, self._latest_message = name, None

    @property
    def latest_message(self) -> Message | None:
        """The last message on the chosen topic since it was chosen, the last request or answer of a service: a copy,
        which is not to be changed."""
        return self._latest_message

    def flow_stats(self) -> Mapping[MessageFlow, FlowStats]:
        """All that was said since the beginning."""
        with self.graph.lock:
            now = self.graph.now_ns
            return MappingProxyType(
                {
                    flow: FlowStats(counter.count, counter.rate(now))
                    for flow, counter in self._counters.items()
                }
            )

    def _count_message(self, time_ns: int, node: GraphNode, name: str, message: Message) -> None:
        """With the graph's lock held, for every message there is: quick."""
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
