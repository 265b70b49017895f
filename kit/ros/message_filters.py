"""Filters that bring messages of several topics together by their time stamps: ROS 2's ``message_filters``.

A filter calls what was registered with it for every message that it passes on. Times are those of the messages'
headers; with ``allow_headerless`` a message without one gets the time at which it came.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from itertools import count, product
from threading import RLock
from typing import Any

from kit.ros.execution.client_library import get_logger
from kit.ros.node.clock import ROSClock
from kit.ros.node.node import Node
from kit.ros.node.subscription import Subscription
from kit.ros.node.time import ClockType, Duration, Time

Callback = Callable[..., Any]


class SimpleFilter:
    """Passes messages on to callbacks."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callback, tuple[Any, ...]]] = {}
        self._numbers = count()

    def registerCallback(self, cb: Callback, *args: Any) -> int:  # ROS 2's name, as all of these
        """Has ``cb(*messages, *args)`` called for each output. Returns the callback's number."""
        number = next(self._numbers)
        self.callbacks[number] = cb, args
        return number

    def signalMessage(self, *msg: Any) -> None:
        """Calls every callback."""
        for cb, args in list(self.callbacks.values()):
            cb(*msg, *args)


class Subscriber(SimpleFilter):
    """Passes on what comes on a topic; the arguments are those of ``Node.create_subscription`` without its callback."""

    def __init__(
        self, node: Node, msg_type: Any, topic: str, *, qos_profile: Any = 10, **kwargs: Any
    ) -> None:
        super().__init__()
        self.node, self.topic = node, topic
        self.sub: Subscription[Any] = node.create_subscription(
            msg_type, topic, self.signalMessage, qos_profile, **kwargs
        )

    def getTopic(self) -> str:
        return self.topic


class Cache(SimpleFilter):
    """Keeps the newest messages of another filter, and passes each on."""

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.allow_headerless = allow_headerless
        self._kept: deque[tuple[Time, Any]] = deque(maxlen=cache_size)
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Takes a message."""
        stamp = _stamp(msg, self.allow_headerless)
        if stamp is not None:
            self._kept.append((stamp, msg))
            self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """The messages from one time to another, in the order in which they came."""
        return [msg for stamp, msg in self._kept if from_stamp <= stamp <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any | None:
        """The first message that is not older than a time."""
        return next((msg for each, msg in self._kept if each >= stamp), None)

    def getElemBeforeTime(self, stamp: Time) -> Any | None:
        """The last message that is not newer than a time."""
        return next((msg for each, msg in reversed(self._kept) if each <= stamp), None)

    def getLatestTime(self) -> Time | None:
        return self._kept[-1][0] if self._kept else None

    getLastestTime = getLatestTime  # noqa: N815  # ROS 2's own spelling

    def getOldestTime(self) -> Time | None:
        return self._kept[0][0] if self._kept else None

    def getLast(self) -> Any | None:
        return self._kept[-1][1] if self._kept else None


class TimeSynchronizer(SimpleFilter):
    """Passes on one message of each filter together when all have the same time stamp."""

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        """``queue_size``: how many messages of each filter are kept while the others are waited for."""
        super().__init__()
        self.queue_size = queue_size
        self.lock = RLock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        self.queues: list[dict[int, Any]] = [{} for _ in fs]
        self.input_connections = [
            each.registerCallback(self.add, queue, number)
            for number, (each, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int) -> None:
        """Takes a message of the filter with this number."""
        stamp = self._stamp(msg)
        if stamp is None:
            return
        with self.lock:
            my_queue[stamp.nanoseconds] = msg
            while len(my_queue) > self.queue_size:
                del my_queue[min(my_queue)]
            stamps = next(self._matches(stamp.nanoseconds, my_queue_index), None)
            if stamps is not None:
                found = zip(self.queues, stamps, strict=True)
                self.signalMessage(*[queue.pop(each) for queue, each in found])

    def _stamp(self, msg: Any) -> Time | None:
        return _stamp(msg, allow_headerless=False)

    def _matches(self, stamp: int, number: int) -> Iterator[Sequence[int]]:
        """Yields the stamps, one for each queue, of messages that belong to one [ns]."""
        if all(stamp in queue for queue in self.queues):
            yield [stamp] * len(self.queues)


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Passes on one message of each filter together when their time stamps lie within ``slop`` seconds."""

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
        sync_arrival_time: bool = False,
    ) -> None:
        """``sync_arrival_time``: by the time at which messages come, whatever their headers say."""
        self.slop = Duration(seconds=slop)
        self.allow_headerless, self.sync_arrival_time = allow_headerless, sync_arrival_time
        super().__init__(fs, queue_size)

    def _stamp(self, msg: Any) -> Time | None:
        return ROSClock().now() if self.sync_arrival_time else _stamp(msg, self.allow_headerless)

    def _matches(self, stamp: int, number: int) -> Iterator[Sequence[int]]:
        slop = self.slop.nanoseconds
        # The nearest of each queue first; in the own one there is only the new message.
        near = [
            [stamp]
            if each == number
            else sorted(
                (other for other in queue if abs(other - stamp) <= slop), key=lambda s: abs(s - stamp)
            )
            for each, queue in enumerate(self.queues)
        ]
        yield from (stamps for stamps in product(*near) if max(stamps) - min(stamps) < slop)


def _stamp(msg: Any, allow_headerless: bool) -> Time | None:
    """The time of a message; None, with a warning, for one without, which is left out."""
    stamp = getattr(getattr(msg, "header", None), "stamp", None)
    if stamp is not None:
        return stamp if isinstance(stamp, Time) else Time.from_msg(stamp, clock_type=ClockType.ROS_TIME)
    if allow_headerless:
        return ROSClock().now()
    get_logger("message_filters").warning(
        f"a {type(msg).__name__} has no header with a time stamp, and is left out; allow_headerless=True takes the time "
        "at which it comes"
    )
    return None
