"""The limits of what the robots of a world carry out: told where a robot is described, and noted where a node commands more."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Iterator
from typing import Any, Final

from kit.msg.geometry_msgs import TwistStamped
from kit.plain_text import join_names
from kit.ros.graph.directory import Excess, NodeLike
from kit.ros.graph.graph import Graph
from kit.sim.plugin import CommandLimit, TopicEndpoint
from kit.sim.simulation import Simulation

EXCESS: Final = 1.001
"""A command of this share of a limit, or more, asks for more: less is the rounding of a command for the limit itself."""


class CommandLimits:
    """Compares each command that a node publishes with the limits of the topic on which the world takes it."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._limits: dict[str, tuple[CommandLimit, ...]] = {}
        self._listens = False

    def add(self, endpoint: TopicEndpoint) -> None:
        """Notes from now on what is asked for on a topic; nothing is listened to for one without limits."""
        if not endpoint.limits:
            return
        self._limits[endpoint.topic] = endpoint.limits
        if not self._listens:
            self._listens = True
            self._graph.add_message_listener(self._on_message)

    def discard(self, endpoint: TopicEndpoint) -> None:
        self._limits.pop(endpoint.topic, None)

    def _on_message(self, _: int, node: NodeLike, topic: str, message: Any) -> None:
        if topic not in self._limits:
            return
        command = message.twist if isinstance(message, TwistStamped) else message
        for limit in self._limits[topic]:
            asked = _field_amount(command, limit.field)
            if limit.largest * EXCESS <= asked < math.inf:
                excess = Excess(f"{asked:g} {limit.unit}", f"{limit.largest:g} {limit.unit}")
                self._graph.directory.note_excess(node.get_fully_qualified_name(), topic, limit.field, excess)


def _field_amount(command: Any, field: str) -> float:
    """The amount of a command's field; 0 for a message of another type, which the world does not take."""
    try:
        return abs(float(operator.attrgetter(field)(command)))
    except (AttributeError, TypeError):
        return 0.0


def describe_limits(simulation: Simulation, robots: Iterable[str]) -> Iterator[str]:
    """Yields a line for each topic on which a robot takes commands: the most that it does of each field."""
    for robot in robots:
        for endpoint in simulation.model_endpoints(robot):
            most = [f"{limit.field} {limit.largest:g} {limit.unit}" for limit in endpoint.limits]
            if most:
                yield f"{robot} does at most {join_names(most)} on {endpoint.topic}."
            elif endpoint.topic in simulation.command_topics(robot):
                yield f"{robot} has no top speed: it does what is asked for on {endpoint.topic}."
