"""Defines what a bridge needs of the wire on the robot's side: topics and services as bytes in CDR."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Final, Protocol

from kit.bridge.routes import BridgeError
from kit.ros.node.qos import QoSProfile

INSTALL_COMMAND: Final = "pip install -c constraints.txt -e '.[robot]'"
"""In the kit's folder."""
DELAY_WINDOW_NS: Final = 5_000_000_000
"""The quickest message of the last one to two windows is what others are compared with."""


def require_package(module: str, package: str) -> None:
    """Raises BridgeError, which says how to install it, where a package of the extra ``robot`` is missing."""
    if find_spec(module) is None:
        raise BridgeError(
            f"This needs the package {package}, which is not installed. In the kit's folder, run:\n"
            f"  {INSTALL_COMMAND}"
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
        """What the robot's side has at present."""

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
        """Nothing arrives."""

    def open_service(
        self, name: str, interface: InterfaceId, on_request: Callable[[bytes, Reply], None]
    ) -> None:
        """Nobody asks."""

    def open_client(self, name: str, interface: InterfaceId) -> Callable[[bytes, OnAnswer], None]:
        return lambda data, on_answer: on_answer(None)

    def close(self) -> None:
        """There is nothing to take back."""


class DelayMeasure:
    """Measures by how much messages are late, each against the quickest of its sender's lately. So it does not matter by
    how much the clocks of the two machines differ, and only for a few seconds if one of them is set again."""

    def __init__(self) -> None:
        self._quickest: dict[bytes, tuple[int, int, int]] = {}
        """By sender: when its window began, the least difference of clocks in it, and in the window before."""

    def add(self, sender: bytes, sent_ns: int, now_ns: int) -> float:
        """How late a message is [s], which was sent at ``sent_ns`` by its sender's clock."""
        offset = now_ns - sent_ns
        began, least, before = self._quickest.get(sender, (now_ns, offset, offset))
        if now_ns - began > DELAY_WINDOW_NS:
            began, before, least = now_ns, least, offset
        least = min(least, offset)
        self._quickest[sender] = began, least, before
        return (offset - min(least, before)) / 1e9
