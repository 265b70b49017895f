"""The open routes of a bridge: each joins an endpoint in the world's graph to one on the wire.

``deliver`` is called in the graph's thread, ``send_stop`` in any; the wire hands over what arrives in threads of its own.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final, NamedTuple

from kit.bridge.motion_guard import MotionGuard
from kit.bridge.rmw_zenoh import NO_TYPE_HASH
from kit.bridge.wire import MAX_MESSAGE_BYTES, BridgeRoute, Direction, InterfaceId, Reply, Wire
from kit.msg.message import Message, Service
from kit.plain_text import format_size
from kit.ros.execution.callback_groups import CallbackGroup
from kit.ros.execution.task import Future
from kit.ros.node.node import Node
from kit.ros.node.qos import QoSProfile
from kit.ros.serialization import Distro, Serializer

MAX_WAITING: Final = 10
"""Messages of one topic, or requests of one service, that may wait until the world takes them; older ones are dropped."""
MAX_UNANSWERED: Final = 100
"""Requests of the robot's that one service of the world's may be at."""
DRY_PERIOD_S: Final = 1.0
"""A dry run shows one message of a topic in this many seconds."""

Report = Callable[[str], None]


@dataclass(slots=True)
class Traffic:
    """Counts of the messages that have passed on one route."""

    count: int = 0
    bytes: int = 0
    dropped: int = 0
    """Messages that did not pass: a stop was in force, or they could not be read."""
    _since_s: float = field(default_factory=time.monotonic)
    _counted: tuple[int, int] = 0, 0

    def add(self, size: int) -> None:
        self.count += 1
        self.bytes += size

    def take_rates(self) -> tuple[float, float]:
        """Messages and bytes per second since the last call."""
        now, (count, size) = time.monotonic(), self._counted
        seconds = max(1e-3, now - self._since_s)
        self._since_s, self._counted = now, (self.count, self.bytes)
        return (self.count - count) / seconds, (self.bytes - size) / seconds


class WireCodec:
    """Converts messages to bytes and back, and knows how types are called on the wire, for one ROS 2 distribution."""

    def __init__(self, distro: Distro) -> None:
        self._serializer = Serializer(distro)
        self._has_hashes = distro != "humble"

    def topic_interface(self, cls: type[Message]) -> InterfaceId:
        type_hash = self._serializer.type_hash(cls) if self._has_hashes else NO_TYPE_HASH
        return InterfaceId(cls.__ros_type__, type_hash)

    def service_interface(self, cls: type[Service]) -> InterfaceId:
        type_hash = self._serializer.service_type_hash(cls) if self._has_hashes else NO_TYPE_HASH
        return InterfaceId(cls.__ros_type__, type_hash)

    def serialize(self, message: Message) -> bytes:
        return self._serializer.serialize(message)

    def deserialize(self, data: bytes, cls: type[Message]) -> Any:
        """Raises ValueError for bytes that are none of it."""
        try:
            return self._serializer.deserialize(data, cls)
        except (IndexError, KeyError, OverflowError, TypeError, UnicodeDecodeError) as problem:
            raise ValueError(f"these bytes are not a {cls.__ros_type__}: {problem}") from None


@dataclass(frozen=True, slots=True)
class ChannelContext:
    """The objects that all channels of a bridge share."""

    node: Node
    wire: Wire
    codec: WireCodec
    report: Report
    group: CallbackGroup
    """Reentrant: a request that waits for the robot's answer must hold up nothing else."""
    is_dry: bool = False


class Channel(ABC):
    """One open route."""

    def __init__(
        self,
        route: BridgeRoute,
        interface: InterfaceId,
        context: ChannelContext,
        guard: MotionGuard | None = None,
    ) -> None:
        self.route = route
        self.interface = interface
        self.guard = guard
        """What watches over its commands; None where it moves no robot."""
        self.traffic = Traffic()
        self._context = context
        self._has_complained = False

    @abstractmethod
    def deliver(self) -> None:
        """Passes on to the graph what has arrived from the wire until now: what arrives meanwhile waits for the next call, so
        that a robot that sends faster than it can be read does not hold the world."""

    def send_stop(self) -> None:
        """Tells the robot to stop."""
        raise AssertionError(f"{self.route} does not move a robot")

    def _is_too_large(self, data: bytes) -> bool:
        """Drops what is larger than a message of a robot's can be, before it waits in memory."""
        if len(data) <= MAX_MESSAGE_BYTES:
            return False
        self._drop(
            f"the robot sent {format_size(len(data))} at once, and {format_size(MAX_MESSAGE_BYTES)} may pass"
        )
        return True

    def _try_wire(self, send: Callable[[], object]) -> bool:
        """Hands something to the wire; returns whether it took it. A wire that refuses keeps nothing else from its work."""
        try:
            send()
        except Exception as problem:  # noqa: BLE001 - each wire's package has errors of its own
            self._drop(f"the wire does not take it: {problem}")
            return False
        return True

    def _drop(self, reason: str) -> None:
        """Counts a message that does not pass; says why for the first of them."""
        self.traffic.dropped += 1
        if not self._has_complained:
            self._has_complained = True
            self._context.report(f"{self.route}: {reason}. Such messages are dropped.")


class SentTopic(Channel):
    """A topic of the world's, to the robot."""

    def __init__(
        self,
        route: BridgeRoute,
        interface: InterfaceId,
        context: ChannelContext,
        cls: type[Message],
        qos: QoSProfile,
        guard: MotionGuard | None,
    ) -> None:
        super().__init__(route, interface, context, guard)
        codec = context.codec
        self._stop_bytes = b"" if guard is None else codec.serialize(guard.stop_message())
        self._shown_s = float("-inf")
        self._send = context.wire.open_publisher(route.wire_name, interface, qos)
        context.node.create_subscription(
            cls, route.name, self._send_if_admitted, qos, callback_group=context.group
        )

    def deliver(self) -> None:
        """Does nothing: on this channel nothing arrives from the wire."""

    def send_stop(self) -> None:
        self._send(self._stop_bytes)

    def _send_if_admitted(self, message: Message) -> None:
        passed = message if self.guard is None else self.guard.admit(message, time.monotonic())
        if passed is None:
            self.traffic.dropped += 1
            return
        try:
            data = self._context.codec.serialize(passed)
        except (TypeError, ValueError, OverflowError) as problem:
            self._drop(f"a message cannot be sent: {problem}")
            return
        if not self._try_wire(lambda: self._send(data)):
            return
        self.traffic.add(len(data))
        if self._context.is_dry and time.monotonic() - self._shown_s >= DRY_PERIOD_S:
            self._shown_s = time.monotonic()
            changed = "" if passed == message else ", slowed down"
            self._context.report(f"would send {self.route.wire_name}, {len(data)} bytes{changed}: {passed!r}")


class _Arrival(NamedTuple):
    """A message from the wire, and by how much it is late [s]."""

    data: bytes
    late_s: float


class ReceivedTopic(Channel):
    """A topic of the robot's, to the world."""

    def __init__(
        self,
        route: BridgeRoute,
        interface: InterfaceId,
        context: ChannelContext,
        cls: type[Message],
        qos: QoSProfile,
        guard: MotionGuard | None,
    ) -> None:
        super().__init__(route, interface, context, guard)
        self._cls = cls
        self._arrived: deque[_Arrival] = deque(maxlen=MAX_WAITING)
        self._is_stop_due = False
        """Apart from the messages: those that arrive after a stop must not push it out."""
        self._publisher = context.node.create_publisher(cls, route.name, qos)
        context.wire.open_subscription(route.wire_name, interface, qos, self._add)

    def _add(self, data: bytes, late_s: float) -> None:
        if not self._is_too_large(data):
            self._arrived.append(_Arrival(data, late_s))

    def deliver(self) -> None:
        if self._is_stop_due:
            self._is_stop_due = False
            self._publisher.publish(self._cls())
        arrived = self._arrived  # ``send_stop`` may put another in its place meanwhile
        for _ in range(len(arrived)):
            data, late_s = arrived.popleft()
            try:
                message = self._context.codec.deserialize(data, self._cls)
                if self.guard is not None:
                    message = self.guard.admit(message, time.monotonic(), late_s)
                if message is None:
                    self.traffic.dropped += 1
                    continue
                self._publisher.publish(message)
            except ValueError as problem:
                self._drop(f"a received message cannot be read: {problem}")
                continue
            self.traffic.add(len(data))

    def send_stop(self) -> None:
        self._arrived = deque(
            maxlen=MAX_WAITING
        )  # what came before the stop must not move the robot after it
        self._is_stop_due = True


class ServedService(Channel):
    """A service of the world's, offered to the robot."""

    def __init__(
        self, route: BridgeRoute, interface: InterfaceId, context: ChannelContext, cls: type[Service]
    ) -> None:
        super().__init__(route, interface, context)
        self._cls = cls
        self._arrived: deque[tuple[bytes, Reply]] = deque(maxlen=MAX_WAITING)
        self._client = context.node.create_client(cls, route.name, callback_group=context.group)
        context.wire.open_service(route.wire_name, interface, self._add)

    def _add(self, data: bytes, reply: Reply) -> None:
        if self._is_too_large(data):
            return
        if len(self._arrived) == MAX_WAITING:
            self._drop(
                f"more than {MAX_WAITING} requests wait for the world, and the oldest gets no answer: let the world run, "
                "and ask again"
            )
        self._arrived.append((data, reply))

    def deliver(self) -> None:
        for _ in range(len(self._arrived)):
            data, reply = self._arrived.popleft()
            try:
                request = self._context.codec.deserialize(data, self._cls.Request)
            except ValueError as problem:
                self._drop(f"a request cannot be read: {problem}")
                continue
            if self._client.pending_count >= MAX_UNANSWERED:
                self._drop(
                    f"the world has not answered {MAX_UNANSWERED} requests yet, and this one gets no answer"
                )
                continue
            self.traffic.add(len(data))
            self._client.call_async(request).add_done_callback(partial(self._reply, reply))

    def _reply(self, reply: Reply, future: Future[Any]) -> None:
        response: Any = future.result()
        data = self._context.codec.serialize(response)
        self._try_wire(lambda: reply(data))


class CalledService(Channel):
    """A service of the robot's, offered in the world."""

    def __init__(
        self, route: BridgeRoute, interface: InterfaceId, context: ChannelContext, cls: type[Service]
    ) -> None:
        super().__init__(route, interface, context)
        self._cls = cls
        self._arrived: deque[tuple[Future[Any], bytes | None]] = deque()
        self._call = context.wire.open_client(route.wire_name, interface)
        context.node.create_service(cls, route.name, self._answer, callback_group=context.group)

    async def _answer(self, request: Message, _: Message) -> Any:
        future: Future[Any] = Future()
        data = self._context.codec.serialize(request)
        self.traffic.add(len(data))
        if not self._try_wire(
            lambda: self._call(data, lambda answer: self._arrived.append((future, answer)))
        ):
            self._arrived.append((future, None))
        return await future

    def deliver(self) -> None:
        for _ in range(len(self._arrived)):
            future, data = self._arrived.popleft()
            if data is None:
                self._drop(
                    "the robot did not answer a request; its caller keeps waiting, as it would on the robot"
                )
                continue
            if self._is_too_large(data):
                continue
            try:
                future.set_result(self._context.codec.deserialize(data, self._cls.Response))
            except ValueError as problem:
                self._drop(f"an answer cannot be read: {problem}")


CHANNEL_OF_DIRECTION: Final[Mapping[Direction, Callable[..., Channel]]] = {
    Direction.SEND: SentTopic,
    Direction.RECEIVE: ReceivedTopic,
}
SERVICE_CHANNELS: Final[Mapping[Direction, Callable[..., Channel]]] = {
    Direction.SERVE: ServedService,
    Direction.CALL: CalledService,
}
