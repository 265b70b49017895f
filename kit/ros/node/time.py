"""Times and durations in whole nanoseconds."""

from __future__ import annotations

import math
from enum import IntEnum
from functools import total_ordering
from typing import Any, overload

from kit.msg.builtin_interfaces import Duration as DurationMessage
from kit.msg.builtin_interfaces import Time as TimeMessage

S_TO_NS = 1_000_000_000
_INT64_MAX = 2**63 - 1


class ClockType(IntEnum):
    """The type of a clock. In a simulation all three show the simulated time."""

    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3


def _to_nanoseconds(seconds: float, nanoseconds: float, what: str) -> int:
    # Whole seconds stay exact; as a float, a time of today is off by up to a hundred nanoseconds.
    total = seconds * S_TO_NS if isinstance(seconds, int) else int(seconds * S_TO_NS)
    total += int(nanoseconds)
    if not -(2**63) <= total <= _INT64_MAX:
        raise OverflowError(f"Total nanoseconds value is too large to store in C {what}.")
    return total


@total_ordering
class Duration:
    """A span of time. ``Duration(seconds=0.5)``."""

    __slots__ = ("_nanoseconds",)

    def __init__(self, *, seconds: float = 0, nanoseconds: float = 0) -> None:
        self._nanoseconds = _to_nanoseconds(seconds, nanoseconds, "duration")

    @property
    def nanoseconds(self) -> int:
        return self._nanoseconds

    def to_msg(self) -> DurationMessage:
        """The duration as a ``builtin_interfaces/msg/Duration``."""
        seconds, nanoseconds = divmod(self._nanoseconds, S_TO_NS)
        return DurationMessage(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: DurationMessage) -> Duration:
        if not isinstance(msg, DurationMessage):
            raise TypeError("Must pass a builtin_interfaces.msg.Duration object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)

    def __add__(self, other: object) -> Duration:
        if not isinstance(other, Duration):
            return NotImplemented
        return Duration(nanoseconds=self._nanoseconds + other._nanoseconds)

    def __sub__(self, other: object) -> Duration:
        if not isinstance(other, Duration):
            return NotImplemented
        return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)

    def __mul__(self, other: object) -> Duration:
        if not isinstance(other, (int, float)):
            return NotImplemented
        if other == math.inf:
            return Infinite
        return Duration(nanoseconds=self._nanoseconds * other)

    def __eq__(self, other: object) -> bool:
        return self._nanoseconds == _as_duration(other)._nanoseconds

    def __lt__(self, other: object) -> bool:
        return self._nanoseconds < _as_duration(other)._nanoseconds

    def __hash__(self) -> int:
        return hash(self._nanoseconds)

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._nanoseconds})"


Infinite = Duration(nanoseconds=_INT64_MAX)
"""For ever, where a quality-of-service setting means a time."""


@total_ordering
class Time:
    """A point in time on a clock of some type; not before that clock's zero."""

    __slots__ = ("_clock_type", "_nanoseconds")

    def __init__(
        self, *, seconds: float = 0, nanoseconds: float = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        self._nanoseconds = _to_nanoseconds(seconds, nanoseconds, "time point")
        self._clock_type = clock_type

    @property
    def nanoseconds(self) -> int:
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """The whole seconds and the remaining nanoseconds."""
        return divmod(self._nanoseconds, S_TO_NS)

    def to_msg(self) -> TimeMessage:
        """The time as a ``builtin_interfaces/msg/Time``, ready for a header's stamp."""
        seconds, nanoseconds = divmod(self._nanoseconds, S_TO_NS)
        return TimeMessage(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: TimeMessage, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        if not isinstance(msg, TimeMessage):
            raise TypeError("Must pass a builtin_interfaces.msg.Time object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)

    def __add__(self, other: object) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        return self._at(self._nanoseconds + other.nanoseconds)

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...

    @overload
    def __sub__(self, other: Duration) -> Time: ...

    def __sub__(self, other: Any) -> Any:
        if isinstance(other, Time):
            self._same_clock(other, "subtract")
            return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)
        if isinstance(other, Duration):
            if other.nanoseconds > self._nanoseconds:
                raise ValueError("Subtraction leads to negative time.")
            return self._at(self._nanoseconds - other.nanoseconds)
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        # Comparing with a plain number would always be False: an error is kinder.
        return self._nanoseconds == self._comparable(other)._nanoseconds

    def __lt__(self, other: object) -> bool:
        return self._nanoseconds < self._comparable(other)._nanoseconds

    def __hash__(self) -> int:
        return hash((self._nanoseconds, self._clock_type))

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._nanoseconds}, clock_type={self._clock_type.name})"

    def _at(self, nanoseconds: int) -> Time:
        return Time(nanoseconds=nanoseconds, clock_type=self._clock_type)

    def _same_clock(self, other: Time, verb: str) -> None:
        if self._clock_type != other._clock_type:
            raise TypeError(
                f"Can't {verb} times with different clock types: {self._clock_type.name} and {other._clock_type.name}"
            )

    def _comparable(self, other: object) -> Time:
        if not isinstance(other, Time):
            raise TypeError(f"Can't compare time with object of type: {type(other).__name__}")
        self._same_clock(other, "compare")
        return other


def _as_duration(other: object) -> Duration:
    if not isinstance(other, Duration):
        raise TypeError(f"Can't compare duration with object of type: {type(other).__name__}")
    return other
