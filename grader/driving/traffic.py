"""What a program published and printed in an episode, second by second."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from typing import Final

import numpy as np

from grader.driving.drive_record import TopicTraffic
from kit.arrays import FloatArray
from kit.host.node_process import NodeProcess
from kit.host.wire import printable
from kit.msg.message import Message, type_name
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Bool
from kit.ros.graph.directory import NodeLike
from kit.ros.graph.graph import Graph

MAX_PRINTED_LINES: Final = 200
"""Lines of a program's output that are kept."""


class TrafficRecorder:
    """Counts the messages on each topic that nodes other than the world's own publish, second by second, and notes what the
    lasers of the world measured ahead, what the program's booleans said and how much it told was left."""

    def __init__(self, graph: Graph, world_node: NodeLike | None) -> None:
        self._world_node = world_node
        self._counts: dict[tuple[str, str], Counter[int]] = {}
        self._nodes: dict[tuple[str, str], set[str]] = {}
        self._ahead: dict[str, list[tuple[float, float, float]]] = {}
        self._flags: dict[str, dict[int, bool]] = {}
        self._feedback_remaining: dict[str, dict[int, float]] = {}
        self.stop = graph.add_message_listener(self._on_message)

    def _on_message(self, time_ns: int, node: NodeLike, name: str, message: Message) -> None:
        if node is self._world_node:
            if isinstance(message, LaserScan) and message.ranges:
                self._ahead.setdefault(name, []).append((time_ns / 1e9, *_ranges_ahead(message)))
            return
        if isinstance(message, Bool):
            self._flags.setdefault(name, {})[time_ns] = bool(message.data)
        remaining = getattr(getattr(message, "feedback", None), "remaining", None)
        if isinstance(remaining, float):
            self._feedback_remaining.setdefault(name, {})[time_ns] = remaining
        key = name, type_name(type(message))
        self._counts.setdefault(key, Counter())[time_ns // 10**9] += 1
        self._nodes.setdefault(key, set()).add(node.handle.full_name)

    def traffic(self) -> Mapping[str, TopicTraffic]:
        return {
            name: TopicTraffic(kind, counts.total(), tuple(sorted(self._nodes[name, kind])), counts)
            for (name, kind), counts in sorted(self._counts.items(), key=lambda each: each[0])
        }

    def ahead(self) -> Mapping[str, FloatArray]:
        """Returns (k, 3) for each laser's topic; see ``GradedDrive``."""
        return {name: np.array(rows, dtype=np.float64) for name, rows in self._ahead.items()}

    def flags(self) -> Mapping[str, FloatArray]:
        """Returns (k, 2) for each topic of booleans; see ``GradedDrive``."""
        return _time_series(self._flags)

    def feedback_remaining(self) -> Mapping[str, FloatArray]:
        """Returns (k, 2) for each topic of an action's feedback; see ``GradedDrive``."""
        return _time_series(self._feedback_remaining)


def _time_series(values: Mapping[str, Mapping[int, float]]) -> Mapping[str, FloatArray]:
    return {
        name: np.array([(time_ns / 1e9, value) for time_ns, value in said.items()], dtype=np.float64)
        for name, said in values.items()
    }


AHEAD: Final = math.radians(60)
"""What a scan sees within this angle to either side of its middle may be called ahead [rad]."""


def _ranges_ahead(scan: LaserScan) -> tuple[float, float]:
    """Returns the range of the ray in the middle, and the nearest of those within ``AHEAD`` of it [m]; nan for none."""
    middle, count = len(scan.ranges) // 2, round(AHEAD / abs(scan.angle_increment or math.inf))
    near = np.asarray(scan.ranges[max(0, middle - count) : middle + count + 1])
    return float(scan.ranges[middle]), float(np.fmin.reduce(near, initial=math.nan))


class PrintedRecorder:
    """Takes what a program prints second by second, since its lines carry no time of their own."""

    def __init__(self, program: NodeProcess) -> None:
        self._program = program
        self._lines: list[str] = []
        self._seconds: list[int] = []

    def take(self, second: int) -> None:
        """Takes what was printed since the last call; of all that, the first lines are kept."""
        for line in self._program.take_output().lines[: MAX_PRINTED_LINES - len(self._lines)]:
            self._lines.append(printable(line.text))
            self._seconds.append(second)

    @property
    def lines(self) -> tuple[str, ...]:
        return tuple(self._lines)

    @property
    def seconds(self) -> tuple[int, ...]:
        """The second of the episode in which each line was printed."""
        return tuple(self._seconds)
