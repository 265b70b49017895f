"""Commands that move robots: never too fast, stopped when they stay away, stopped on demand."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.bridge.motion_guard import (
    MOTION_FIELDS,
    STOP_REPEATS,
    MotionGuard,
    SpeedLimit,
    is_standstill,
    moves_robots,
)
from kit.msg.geometry_msgs import Twist
from kit.msg.interfaces import find_message
from kit.msg.std_msgs import String
from tests.bridge.sides import twist

WATCHDOG_S = 0.5
numbers = st.floats(allow_nan=True, allow_infinity=True, width=32)


def guard(limit: SpeedLimit | None = None) -> MotionGuard:
    return MotionGuard(Twist, limit or SpeedLimit(1.0, 2.0), WATCHDOG_S)


def filled(cls: type[Any], values: list[float]) -> Any:
    """A command with these numbers."""
    message = cls()
    motion = MOTION_FIELDS[cls.__ros_type__](message)
    if hasattr(motion, "speed"):
        motion.speed, motion.steering_angle = values[:2]
    else:
        for vector, part in ((motion.linear, values[:3]), (motion.angular, values[3:6])):
            vector.x, vector.y, vector.z = part
    return message


@given(st.sampled_from(sorted(MOTION_FIELDS)), st.lists(numbers, min_size=6, max_size=6))
def test_nothing_faster_than_the_limit_passes(name: str, values: list[float]) -> None:
    cls = find_message(name)
    assert moves_robots(cls)
    message = filled(cls, values)
    limit = SpeedLimit(0.4, 1.1)
    passed = MotionGuard(cls, limit, WATCHDOG_S).admit(message, 0.0)
    assert passed is not None
    motion = MOTION_FIELDS[name](passed)
    if hasattr(motion, "speed"):
        assert abs(motion.speed) <= 0.4 + 1e-6
        assert math.isfinite(motion.steering_angle)
        return
    assert math.hypot(motion.linear.x, motion.linear.y, motion.linear.z) <= 0.4 + 1e-9
    assert math.hypot(motion.angular.x, motion.angular.y, motion.angular.z) <= 1.1 + 1e-9


def test_a_fast_command_keeps_its_direction_and_the_senders_message_is_left_alone() -> None:
    message = twist(-3.0, 0.5)
    message.linear.y = 4.0
    watched = guard()
    passed: Any = watched.admit(message, 0.0)
    assert (passed.linear.x, passed.linear.y, passed.angular.z) == pytest.approx((-0.6, 0.8, 0.5))
    assert (message.linear.x, message.linear.y) == (-3.0, 4.0)
    assert watched.limited_count == 1
    assert watched.admit(twist(0.5), 0.1) == twist(0.5)
    assert watched.limited_count == 1


def test_other_types_move_no_robot() -> None:
    assert not moves_robots(String)
    assert is_standstill(Twist())
    assert not is_standstill(twist(0.0, 0.1))


def test_silence_stops_a_moving_robot_a_few_times_and_commands_go_on() -> None:
    watched = guard()
    assert not watched.is_stop_due(1e9), "before the first command"
    watched.admit(twist(1.0), 10.0)
    assert not watched.is_stop_due(10.0 + 0.9 * WATCHDOG_S)
    due = [watched.is_stop_due(10.0 + WATCHDOG_S * k) for k in range(1, 10)]
    assert due == [True] * STOP_REPEATS + [False] * (9 - STOP_REPEATS)
    assert watched.is_silent
    assert watched.admit(twist(0.5), 20.0) == twist(0.5)
    assert not watched.is_silent
    assert watched.is_stop_due(20.0 + WATCHDOG_S)


def test_silence_after_a_stop_needs_no_other() -> None:
    watched = guard()
    watched.admit(twist(1.0), 0.0)
    watched.admit(twist(0.0), 0.1)
    assert not watched.is_stop_due(100.0)


def test_a_stop_lets_nothing_pass_until_it_is_lifted() -> None:
    watched = guard()
    watched.admit(twist(1.0), 0.0)
    watched.stop()
    assert watched.admit(twist(1.0), 0.1) is None
    assert not watched.is_stop_due(100.0)
    assert watched.stop_message() == Twist()
    watched.resume()
    assert watched.admit(twist(1.0), 0.2) == twist(1.0)


def test_commands_that_a_line_has_held_up_do_not_pass() -> None:
    watched = guard()
    assert watched.admit(twist(1.0), 0.0, late_s=0.9 * WATCHDOG_S) is not None
    assert watched.admit(twist(1.0), 0.0, late_s=1.1 * WATCHDOG_S) is None
