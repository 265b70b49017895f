"""Defines what a bridge joins: the topics and services that may pass, and the wire on the robot's side that carries them.

On the wire they are bytes in CDR.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from importlib.util import find_spec
from typing import Final, Protocol

from kit.installation import install_command
from kit.ros.exceptions import NameValidationException
from kit.ros.graph.naming import validate_full_topic_name
from kit.ros.node.qos import QoSProfile

MAX_MESSAGE_BYTES: Final = 32_000_000
"""Bytes of one message, request or answer that is taken from the robot: more than a picture of 4K has."""
MAX_ENDPOINTS: Final = 10_000
"""Endpoints on the robot's side that are kept; those beyond are not seen."""
MAX_SENDERS: Final = 1000
"""Senders whose delays are kept; those heard first make room for others."""
DELAY_WINDOW_NS: Final = 5_000_000_000
"""The quickest message of the last one to two windows is what others are compared with."""


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


def require_package(module: str, package: str) -> None:
    """Raises BridgeError, which says how to install it, where a package of the extra ``robot`` is missing."""
    if find_spec(module) is None:
        raise BridgeError(
            f"This needs the package {package}, which is not installed. To have it, type:\n"
            f"  {install_command('robot')}"
        )


@dataclass(frozen=True, slots=True)
class InterfaceId:
    """A type, by its name and the hash of its definition."""

    name: str
    """``std_msgs/msg/String``"""
    type_hash: str


@dataclass(frozen=True, slots=True)
class RemoteEndpoint:
    """A topic or service that somebody on the robot's side has."""

    name: str
    type_name: str
    type_hash: str
    """Empty where it does not say."""
    role: str
    """``publisher``, ``subscription``, ``service`` or ``client``."""
    node: str
    is_transient_local: bool = False


SendBytes = Callable[[bytes], None]
OnMessage = Callable[[bytes, float], None]
"""Gets a message, and by how many seconds it has taken longer than the quickest of its sender's."""
Reply = Callable[[bytes], None]
OnAnswer = Callable[[bytes | None], None]
"""Gets the response, or None where none came in time."""


class Wire(Protocol):
    """The robot's side. What arrives is handed over in threads of the wire's own."""

    def endpoints(self) -> tuple[RemoteEndpoint, ...]:
        """Returns the endpoints that the robot's side has at present."""

    def open_publisher(self, name: str, interface: InterfaceId, qos: QoSProfile) -> SendBytes:
        """Announces a publisher; returns what sends a message."""

    def open_subscription(
        self, name: str, interface: InterfaceId, qos: QoSProfile, on_message: OnMessage
    ) -> None:
        """Announces a subscription."""

    def open_service(
        self, name: str, interface: InterfaceId, on_request: Callable[[bytes, Reply], None]
    ) -> None:
        """Announces a service; ``on_request`` gets each request and what answers it."""

    def open_client(self, name: str, interface: InterfaceId) -> Callable[[bytes, OnAnswer], None]:
        """Announces a client; returns what sends a request."""

    def close(self) -> None:
        """Takes everything back. May be called twice."""


class DryRunWire:
    """A wire that nothing is sent on: for a look at what would be."""

    def endpoints(self) -> tuple[RemoteEndpoint, ...]:
        return ()

    def open_publisher(self, name: str, interface: InterfaceId, qos: QoSProfile) -> SendBytes:
        return lambda data: None

    def open_subscription(
        self, name: str, interface: InterfaceId, qos: QoSProfile, on_message: OnMessage
    ) -> None:
        """Does nothing: on this wire nothing arrives."""

    def open_service(
        self, name: str, interface: InterfaceId, on_request: Callable[[bytes, Reply], None]
    ) -> None:
        """No-op: nobody calls services on this wire."""

    def open_client(self, name: str, interface: InterfaceId) -> Callable[[bytes, OnAnswer], None]:
        return lambda data, on_answer: on_answer(None)

    def close(self) -> None:
        """Does nothing: this wire has announced nothing."""


class DelayMeasure:
    """Measures by how much messages are late, each against the quickest of its sender's lately. So it does not matter by
    how much the clocks of the two machines differ, and only for a few seconds if one of them is set again."""

    def __init__(self) -> None:
        self._quickest: dict[bytes, tuple[int, int, int]] = {}
        """By sender: start of its window, and the least difference of clocks in it and in the window before."""

    def add(self, sender: bytes, sent_ns: int, now_ns: int) -> float:
        """How late a message is [s], which was sent at ``sent_ns`` by its sender's clock."""
        offset = now_ns - sent_ns
        began, least, before = self._quickest.get(sender, (now_ns, offset, offset))
        if now_ns - began > DELAY_WINDOW_NS:
            began, before, least = now_ns, least, offset
        least = min(least, offset)
        self._quickest[sender] = began, least, before
        if len(self._quickest) > MAX_SENDERS:
            del self._quickest[next(iter(self._quickest))]
        return (offset - min(least, before)) / 1e9
