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
    from kit.ros.graph.graph import Graph
    from kit.ros.node.node import Node

WINDOW: Final = 50
"""Messages over which a rate is taken."""

SILENT: Final = 3.0
"""A flow is silent after this many of its own periods, or after so many seconds if that is longer."""


class Flow(NamedTuple):
    """What one node says under one name."""

    node: str
    """Full name."""
    name: str
    """Of the topic or service."""
    is_service: bool = False
    answer_to: str | None = None
    """For a service's answers: the node that had asked."""


@dataclass(frozen=True, slots=True)
class Said:
    """How much was said so far."""

    count: int
    rate: float | None
    """Messages per second of the graph's time; None while it is silent, or too new to tell."""


@dataclass(slots=True)
class _Tally:
    count: int = 0
    times: deque[int] = field(default_factory=lambda: deque(maxlen=WINDOW))
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
        if not 0 <= now_ns - times[-1] <= max(SILENT * period, SILENT * 1e9):
            return None
        return 1e9 / period


class Traffic:
    """Listens in a graph until ``stop()``. Safe to be asked from any thread."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self._tallies: dict[Flow, _Tally] = {}
        self._asked: dict[str, deque[str]] = {}
        self._chosen: str | None = None
        self._newest: Message | None = None
        self.stop = graph.watch(self._hear)

    def choose(self, name: str | None) -> None:
        """The topic or service whose newest message is kept from now on."""
        with self.graph.lock:
            if name != self._chosen:
                self._chosen, self._newest = name, None

    @property
    def newest(self) -> Message | None:
        """The last message on the chosen topic since it was chosen, the last request or answer of a service: a copy,
        which is not to be changed."""
        return self._newest

    def said(self) -> Mapping[Flow, Said]:
        """All that was said since the beginning."""
        with self.graph.lock:
            now = self.graph.now_ns
            return MappingProxyType(
                {flow: Said(tally.count, tally.rate(now)) for flow, tally in self._tallies.items()}
            )

    def _hear(self, time_ns: int, node: Node, name: str, message: Message) -> None:
        """With the graph's lock held, for every message there is: quick."""
        flow = self._flow(node.handle.full_name, name, type_name(type(message)))
        tally = self._tallies.get(flow)
        if tally is None:
            tally = self._tallies[flow] = _Tally()
        tally.add(time_ns)
        if name == self._chosen:
            self._newest = message.__deepcopy__(None)

    def _flow(self, speaker: str, name: str, kind: str) -> Flow:
        if kind.endswith("_Request"):
            self._asked.setdefault(name, deque(maxlen=WINDOW)).append(speaker)
            return Flow(speaker, name, is_service=True)
        if kind.endswith("_Response"):
            waiting = self._asked.get(name)
            return Flow(speaker, name, is_service=True, answer_to=waiting.popleft() if waiting else None)
        return Flow(speaker, name)
