"""Defines the allow-list of a bridge: which topics and services pass, which way, and under which names."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum

from kit.ros.exceptions import NameValidationException
from kit.ros.graph.naming import validate_full_topic_name


class BridgeError(Exception):
    """The bridge cannot be made as asked; the message says why and what to do."""


class Direction(Enum):
    """Which way something passes."""

    SEND = "send"
    """A topic's messages, from the world to the robot."""
    RECEIVE = "receive"
    """A topic's messages, from the robot to the world."""
    SERVE = "serve"
    """A service of the world's, offered to the robot."""
    CALL = "call"
    """A service of the robot's, offered in the world."""

    @property
    def is_topic(self) -> bool:
        return self in (Direction.SEND, Direction.RECEIVE)


@dataclass(frozen=True, slots=True)
class BridgeRoute:
    """One topic or service that may pass."""

    direction: Direction
    name: str
    """Absolute, in the world's graph."""
    wire_name: str
    """Absolute, on the robot's side."""

    def __str__(self) -> str:
        other = "" if self.name == self.wire_name else f" ({self.wire_name} on the robot)"
        return f"{self.direction.value} {self.name}{other}"

    @classmethod
    def parse(cls, direction: Direction, text: str) -> BridgeRoute:
        """Reads ``/cmd_vel``, or ``/cmd_vel:=/robot/cmd_vel`` where the robot has another name for it.

        Raises BridgeError for a name that is none.

        >>> BridgeRoute.parse(Direction.SEND, "cmd_vel:=/robot/cmd_vel").wire_name
        '/robot/cmd_vel'
        """
        here, _, there = text.partition(":=")
        return cls(direction, _absolute(here, direction), _absolute(there or here, direction))


def _absolute(name: str, direction: Direction) -> str:
    absolute = name if name.startswith("/") else f"/{name}"
    if absolute == "/":
        raise BridgeError(
            f"--{direction.value} {name}: a name is missing; write /cmd_vel, or /cmd_vel:=/robot/cmd_vel"
        )
    try:
        validate_full_topic_name(absolute, is_service=not direction.is_topic)
    except NameValidationException as problem:
        raise BridgeError(f"--{direction.value} {name}: {problem}") from None
    return absolute


def check_routes(routes: Sequence[BridgeRoute]) -> None:
    """Raises BridgeError unless the routes fit together: something passes, each once, and nothing in a circle."""
    if not routes:
        raise BridgeError(
            "Nothing would pass: list each topic and service. --send /cmd_vel sends commands to the robot, "
            "--receive /scan lets scans in; --serve and --call do the same for services."
        )
    _refuse_twice((route.name, route.direction.is_topic) for route in routes)
    _refuse_twice((route.wire_name, route.direction.is_topic) for route in routes)


def _refuse_twice(names: Iterable[tuple[str, bool]]) -> None:
    seen: set[tuple[str, bool]] = set()
    for name, is_topic in names:
        if (name, is_topic) in seen:
            raise BridgeError(
                f"{name} is listed twice: "
                + (
                    "sent and received under the same name, its messages would circulate forever"
                    if is_topic
                    else "a service has only one server"
                )
            )
        seen.add((name, is_topic))
