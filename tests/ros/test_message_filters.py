"""message_filters: messages of several topics brought together by their stamps."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.builtin_interfaces import Time as TimeMessage
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Header, String
from kit.ros.graph.graph import Graph
from kit.ros.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    SimpleFilter,
    Subscriber,
    TimeSynchronizer,
)
from kit.ros.node.node import create_graph_node
from kit.ros.node.time import ClockType, Time


def scan(milliseconds: int, name: str = "") -> LaserScan:
    stamp = TimeMessage(sec=milliseconds // 1000, nanosec=milliseconds % 1000 * 1_000_000)
    return LaserScan(header=Header(stamp=stamp, frame_id=name))


def at(milliseconds: int) -> Time:
    return Time(nanoseconds=milliseconds * 1_000_000, clock_type=ClockType.ROS_TIME)


def synchronized(
    kind: type[TimeSynchronizer], sent: list[tuple[int, int]], **settings: Any
) -> list[list[int]]:
    """The stamps [ms] of what a synchronizer of two filters passes on; ``sent``: number of the filter and stamp."""
    inputs, found = [SimpleFilter(), SimpleFilter()], []
    kind(inputs, **settings).registerCallback(
        lambda *messages: found.append(
            [each.header.stamp.sec * 1000 + each.header.stamp.nanosec // 1_000_000 for each in messages]
        )
    )
    for number, milliseconds in sent:
        inputs[number].signalMessage(scan(milliseconds))
    return found


def test_equal_stamps_come_together_whatever_came_between() -> None:
    sent = [(0, 10), (0, 20), (1, 15), (1, 20), (0, 30), (1, 10), (1, 30)]
    assert synchronized(TimeSynchronizer, sent, queue_size=5) == [[20, 20], [10, 10], [30, 30]]
    assert synchronized(TimeSynchronizer, sent, queue_size=1) == [[20, 20], [30, 30]]  # 10 was pushed out


def test_near_stamps_come_together_the_nearest_first_and_each_message_once() -> None:
    settings = {"queue_size": 10, "slop": 0.05}
    assert synchronized(ApproximateTimeSynchronizer, [(0, 100), (1, 140)], **settings) == [[100, 140]]
    assert synchronized(ApproximateTimeSynchronizer, [(0, 100), (1, 160)], **settings) == []
    sent = [(0, 100), (0, 130), (1, 125), (1, 110)]
    assert synchronized(ApproximateTimeSynchronizer, sent, **settings) == [[130, 125], [100, 110]]


def test_three_must_be_near_each_other_and_not_only_the_newest() -> None:
    inputs, found = [SimpleFilter() for _ in range(3)], []
    ApproximateTimeSynchronizer(inputs, 10, 0.05).registerCallback(lambda *messages: found.append(messages))
    for number, milliseconds in [(0, 100), (1, 160), (2, 130)]:
        inputs[number].signalMessage(scan(milliseconds))
    assert found == []  # 100 and 160 are both near 130, but not near each other
    inputs[0].signalMessage(scan(150))
    assert len(found) == 1


def test_without_a_header_the_time_of_coming_counts_only_if_allowed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for is_allowed in (False, True):
        inputs, found = [SimpleFilter(), SimpleFilter()], []
        made = ApproximateTimeSynchronizer(inputs, 10, 5.0, allow_headerless=is_allowed)
        made.registerCallback(lambda *messages, found=found: found.append(messages))
        for each in inputs:
            each.signalMessage(String(data="a"))
        assert len(found) == is_allowed


def test_a_cache_is_asked_by_time() -> None:
    source = SimpleFilter()
    cache, passed = Cache(source, 3), []
    assert cache.getLast() is None
    cache.registerCallback(lambda message, more: passed.append((message.header.frame_id, more)), "more")
    for milliseconds in (10, 20, 30, 40):
        source.signalMessage(scan(milliseconds, str(milliseconds)))
    assert passed[0] == ("10", "more")
    assert [each.header.frame_id for each in cache.getInterval(at(15), at(30))] == ["20", "30"]
    assert cache.getElemAfterTime(at(21)).header.frame_id == "30"
    assert cache.getElemBeforeTime(at(39)).header.frame_id == "30"
    assert cache.getElemBeforeTime(at(19)) is None
    assert (cache.getOldestTime(), cache.getLatestTime()) == (at(20), at(40))
    assert cache.getLast().header.frame_id == "40"


def test_topics_of_a_node_are_synchronized() -> None:
    graph, found = Graph(), []
    node = create_graph_node(graph, "node")
    filters = [Subscriber(node, LaserScan, name, qos_profile=5) for name in ("front", "rear")]
    TimeSynchronizer(filters, 5).registerCallback(lambda *messages: found.append(messages))
    assert filters[0].getTopic() == "front"
    for name in ("front", "rear"):
        node.create_publisher(LaserScan, name, 5).publish(scan(10, name))
    graph.run_due()
    assert [[each.header.frame_id for each in messages] for messages in found] == [["front", "rear"]]
