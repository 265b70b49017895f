"""Times, durations, clocks."""

from __future__ import annotations

import math
import operator
import threading
import time
from typing import Any

import pytest

from kit.msg.builtin_interfaces import Duration as DurationMessage
from kit.msg.builtin_interfaces import Time as TimeMessage
from kit.ros.exceptions import NotInitializedException
from kit.ros.execution.context import context_of, default_context
from kit.ros.graph.graph import Graph
from kit.ros.node.clock import Clock, JumpThreshold, ROSClock
from kit.ros.node.node import create_graph_node
from kit.ros.node.time import ClockType, Duration, Infinite, Time


def test_seconds_and_nanoseconds_add_up() -> None:
    assert Duration(seconds=1, nanoseconds=5).nanoseconds == 1_000_000_005
    assert Duration(seconds=-0.5).nanoseconds == -500_000_000
    assert Time(seconds=1_700_000_000, nanoseconds=1).nanoseconds == 1_700_000_000_000_000_001
    assert Time(seconds=2, nanoseconds=7).seconds_nanoseconds() == (2, 7)


@pytest.mark.parametrize("wrong", [{"seconds": -1}, {"nanoseconds": -1}])
def test_a_time_is_not_before_its_zero(wrong: dict[str, int]) -> None:
    with pytest.raises(ValueError, match="must not be negative"):
        Time(**wrong)


def test_neither_is_endless() -> None:
    for cls in (Time, Duration):
        with pytest.raises(OverflowError):
            cls(seconds=10**12)
    with pytest.raises(TypeError):
        Time(clock_type="ROS")


def test_messages_and_back() -> None:
    message = Time(seconds=3, nanoseconds=4).to_msg()
    assert message == TimeMessage(sec=3, nanosec=4)
    assert Time.from_msg(message).clock_type is ClockType.ROS_TIME
    assert Duration(nanoseconds=-1).to_msg() == DurationMessage(sec=-1, nanosec=999_999_999)
    assert Duration.from_msg(DurationMessage(sec=-1, nanosec=999_999_999)).nanoseconds == -1
    for cls in (Time, Duration):
        with pytest.raises(TypeError):
            cls.from_msg("3")


def test_arithmetic() -> None:
    start, span = Time(seconds=5), Duration(seconds=2)
    assert start + span == span + start == Time(seconds=7)
    assert start - span == Time(seconds=3)
    assert Time(seconds=7) - start == span
    assert start < start + span
    assert span > Duration()
    for negative in (lambda: start - Duration(seconds=6), lambda: start + Duration(seconds=-6)):
        with pytest.raises(ValueError, match="negative"):
            negative()
    assert (span + span - Duration(seconds=1)) * 2 == Duration(seconds=6)
    assert span * math.inf == Infinite
    for wrong in (5, 1.0, start):
        with pytest.raises(TypeError):
            start + wrong


@pytest.mark.parametrize("compare", [operator.eq, operator.ne, operator.lt, operator.ge])
def test_comparing_with_something_else_is_an_error_not_a_surprise(compare: Any) -> None:
    with pytest.raises(TypeError):
        compare(Time(nanoseconds=5), 5)
    with pytest.raises(TypeError):
        compare(Duration(nanoseconds=5), 5)
    with pytest.raises(TypeError, match="different clock types"):
        compare(Time(clock_type=ClockType.ROS_TIME), Time(clock_type=ClockType.STEADY_TIME))


def test_the_difference_of_two_clocks_times_is_an_error() -> None:
    with pytest.raises(TypeError, match="different clock types"):
        Time(clock_type=ClockType.ROS_TIME) - Time()


def test_clocks_of_a_program_that_stands_alone(alone: Graph) -> None:
    now = time.time_ns()
    assert abs(Clock().now().nanoseconds - now) < 5_000_000_000
    steady = Clock(clock_type=ClockType.STEADY_TIME).now()
    assert abs(steady.nanoseconds - time.monotonic_ns()) < 5_000_000_000
    assert not ROSClock().ros_time_is_active
    with pytest.raises(TypeError):
        Clock(clock_type=1)


def test_sleeping(alone: Graph) -> None:
    clock = create_graph_node(alone, "n").get_clock()
    began = time.monotonic()
    assert clock.sleep_for(Duration(seconds=0.02), context_of(alone))
    assert clock.sleep_until(clock.now() + Duration(seconds=0.02), context_of(alone))
    assert 0.04 <= time.monotonic() - began < 2
    assert clock.sleep_until(Time(clock_type=ClockType.ROS_TIME), context_of(alone)), "long past"
    with pytest.raises(ValueError, match="clock type"):
        clock.sleep_until(Time(), context_of(alone))
    threading.Timer(0.02, context_of(alone).try_shutdown).start()
    assert not clock.sleep_for(Duration(seconds=60), context_of(alone))
    with pytest.raises(NotInitializedException):
        clock.sleep_for(Duration(), context_of(alone))


def test_sleeping_in_simulated_time(graph: Graph) -> None:
    slept: list[int] = []

    def sleep() -> None:
        with default_context(context_of(graph)):
            create_graph_node(graph, "n").get_clock().sleep_for(Duration(seconds=1))
        slept.append(graph.now_ns)

    thread = threading.Thread(target=sleep)
    thread.start()
    while not graph.waiting_threads:
        time.sleep(0.001)
    for tick in range(1, 12):
        graph.advance(tick * 100_000_000)
        time.sleep(0.002)
    thread.join(5)
    assert slept
    assert slept[0] >= 1_000_000_000


def test_jumps_of_time_are_told(graph: Graph) -> None:
    """A world that begins anew sets its time back."""
    told: list[Any] = []
    clock = create_graph_node(graph, "watch").get_clock()
    threshold = JumpThreshold(min_forward=Duration(seconds=1), min_backward=Duration(seconds=-1))
    handle = clock.create_jump_callback(
        threshold,
        pre_callback=lambda: told.append(clock.now().nanoseconds),
        post_callback=lambda jump: told.append((jump.delta.nanoseconds, jump.clock_change.name)),
    )
    graph.advance(500_000_000)
    assert told == []
    graph.advance(1_500_000_000)
    assert told == [500_000_000, (1_000_000_000, "ROS_TIME_NO_CHANGE")]
    told.clear()
    graph.advance(0)
    assert told == [1_500_000_000, (-1_500_000_000, "ROS_TIME_NO_CHANGE")]
    handle.unregister()
    handle.unregister()
    graph.advance(9_000_000_000)
    assert len(told) == 2


def test_thresholds_that_make_no_sense_are_refused() -> None:
    second, back = Duration(seconds=1), Duration(seconds=-1)
    for wrong in (
        {"min_forward": back, "min_backward": None},
        {"min_forward": None, "min_backward": second},
        {"min_forward": None, "min_backward": None, "on_clock_change": False},
    ):
        with pytest.raises(ValueError, match="must be"):
            JumpThreshold(**wrong)  # type: ignore[arg-type]  # each has other keywords
    with pytest.raises(ValueError, match="callable"):
        Clock().create_jump_callback(JumpThreshold(min_forward=second, min_backward=None))


def test_a_node_is_waited_for() -> None:
    graph = Graph(None)
    node = create_graph_node(graph, "first")
    assert node.wait_for_node("first", 0.0)
    assert not node.wait_for_node("/second", 0.01)
    threading.Timer(0.02, create_graph_node, (graph, "second")).start()
    assert node.wait_for_node("/second", 10.0)


def test_a_clock_of_ros_time_is_a_ros_clock() -> None:
    """As rclpy's own tests have it."""
    clock = Clock(clock_type=ClockType.ROS_TIME)
    assert isinstance(clock, ROSClock)
    assert clock.clock_type is ROSClock().clock_type is ClockType.ROS_TIME
    assert not isinstance(Clock(clock_type=ClockType.STEADY_TIME), ROSClock)
