"""Guards the commands that move a robot: limits their speed, and stops the robot when they stay away or on demand."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, Final

from kit.msg.message import Message

STOP_REPEATS: Final = 3
"""A stop is sent this many times, for one may be lost."""

MOTION_FIELDS: Final[dict[str, Callable[[Any], Any]]] = {
    "geometry_msgs/msg/Twist": lambda message: message,
    "geometry_msgs/msg/TwistStamped": lambda message: message.twist,
    "ackermann_msgs/msg/AckermannDrive": lambda message: message,
    "ackermann_msgs/msg/AckermannDriveStamped": lambda message: message.drive,
}
"""The types that move robots, and where in them the motion is."""


def moves_robots(cls: type[Message]) -> bool:
    """Returns whether messages of this type are commands that a guard understands."""
    return cls.__ros_type__ in MOTION_FIELDS


@dataclass(frozen=True, slots=True)
class SpeedLimit:
    """The fastest motion that passes. Faster commands are slowed down, in the direction that they had."""

    linear: float = 0.5
    """m/s"""
    angular: float = 1.5
    """rad/s"""

    def apply(self, message: Message) -> bool:
        """Limits a command in place; returns whether it had to. What is no finite number becomes a stop."""
        motion = MOTION_FIELDS[type(message).__ros_type__](message)
        if hasattr(motion, "speed"):
            return self._limit_car(motion)
        return any([_limit_vector(motion.linear, self.linear), _limit_vector(motion.angular, self.angular)])

    def _limit_car(self, motion: Any) -> bool:
        if not (math.isfinite(motion.speed) and math.isfinite(motion.steering_angle)):
            motion.speed = motion.steering_angle = 0.0
            return True
        limited = max(-self.linear, min(self.linear, motion.speed))
        was_limited = bool(limited != motion.speed)
        motion.speed = limited
        return was_limited


USUAL_LIMIT: Final = SpeedLimit()


def _limit_vector(vector: Any, most: float) -> bool:
    length = math.hypot(vector.x, vector.y, vector.z)
    if not math.isfinite(length):
        vector.x = vector.y = vector.z = 0.0
        return True
    if length <= most:
        return False
    factor = most / length
    vector.x, vector.y, vector.z = vector.x * factor, vector.y * factor, vector.z * factor
    return True


def is_standstill(message: Message) -> bool:
    """Returns whether a command asks the robot to stop."""
    motion = MOTION_FIELDS[type(message).__ros_type__](message)
    if hasattr(motion, "speed"):
        return bool(motion.speed == 0.0)
    return all(
        getattr(vector, axis) == 0.0 for vector in (motion.linear, motion.angular) for axis in ("x", "y", "z")
    )


class MotionGuard:
    """Decides what passes on one topic that moves robots, and when a stop has to be sent. May be used by several threads.

    Times are seconds of one clock, which the caller chooses: on the wire that of the wall.
    """

    def __init__(self, cls: type[Message], limit: SpeedLimit, watchdog_s: float) -> None:
        self._cls = cls
        self._limit = limit
        self._watchdog_s = watchdog_s
        self._lock = threading.Lock()
        self._last_s = -math.inf
        self._is_moving = False
        self._repeats_left = 0
        self._is_stopped = False
        self.is_silent = False
        """Whether the watchdog has stopped the robot, and no command has come since."""
        self.limited_count = 0

    @property
    def is_stopped(self) -> bool:
        """Whether a stop is in force: no command passes until ``resume``."""
        return self._is_stopped

    def stop_message(self) -> Message:
        """A command to stop."""
        return self._cls()

    def admit(self, message: Message, now_s: float, late_s: float = 0.0) -> Message | None:
        """The command as it may pass, a copy; None while a stop is in force, and for one that is late by more than the
        watchdog's time: a line that was held up brings them when it flows again."""
        passed = deepcopy(message)
        with self._lock:
            if self._is_stopped or late_s > self._watchdog_s:
                return None
            self.limited_count += self._limit.apply(passed)
            self._last_s, self._is_moving = now_s, not is_standstill(passed)
            self._repeats_left, self.is_silent = STOP_REPEATS, False
            return passed

    def is_stop_due(self, now_s: float) -> bool:
        """Whether a stop has to be sent now: nothing has come for the watchdog's time, and the robot may be moving.

        True for a few calls, a watchdog's time apart.
        """
        with self._lock:
            if not self._is_moving or now_s - self._last_s < self._watchdog_s:
                return False
            self._last_s, self.is_silent = now_s, True
            self._repeats_left -= 1
            self._is_moving = self._repeats_left > 0
            return True

    def stop(self) -> None:
        """Lets no command pass until ``resume``."""
        with self._lock:
            self._is_stopped, self._is_moving = True, False

    def resume(self) -> None:
        """Lets commands pass again; the robot stands until the next one."""
        with self._lock:
            self._is_stopped = False
