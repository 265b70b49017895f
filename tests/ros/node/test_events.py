"""Event callbacks of publishers and subscriptions: matched, incompatible, and missed deadlines."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.std_msgs import Int32, String
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.events import PublisherEventCallbacks, SubscriptionEventCallbacks
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSProfile,
    qos_profile_sensor_data,
)
from kit.ros.node.time import Duration

MS = 1_000_000


@pytest.fixture
def node(graph: Graph) -> Node:
    return create_graph_node(graph, "node")


def ignore(_: Any) -> None:
    pass


class TestMatched:
    def test_a_publisher_hears_of_subscriptions_that_come_and_go(self, graph: Graph, node: Node) -> None:
        events: list[Any] = []
        node.create_publisher(Int32, "x", 1, event_callbacks=PublisherEventCallbacks(matched=events.append))
        first = node.create_subscription(Int32, "x", ignore, 1)
        graph.run_due()
        node.create_subscription(Int32, "x", ignore, 1)
        graph.run_due()
        first.destroy()
        graph.run_due()
        seen = [
            (e.total_count, e.total_count_change, e.current_count, e.current_count_change) for e in events
        ]
        assert seen == [(1, 1, 1, 1), (2, 1, 2, 1), (2, 0, 1, -1)]

    def test_what_happens_before_the_callback_runs_is_counted_together(
        self, graph: Graph, node: Node
    ) -> None:
        events: list[Any] = []
        callbacks = SubscriptionEventCallbacks(matched=events.append, liveliness=events.append)
        node.create_subscription(Int32, "x", ignore, 1, event_callbacks=callbacks)
        node.create_publisher(Int32, "x", 1)
        node.create_publisher(Int32, "x", 1)
        graph.run_due()
        matched, liveliness = events
        assert (matched.total_count, matched.total_count_change, matched.current_count) == (2, 2, 2)
        assert (liveliness.alive_count, liveliness.alive_count_change, liveliness.not_alive_count) == (
            2,
            2,
            0,
        )

    def test_an_incompatible_endpoint_does_not_match(self, graph: Graph, node: Node) -> None:
        matched: list[Any] = []
        refused: list[Any] = []
        callbacks = SubscriptionEventCallbacks(matched=matched.append, incompatible_qos=refused.append)
        node.create_subscription(Int32, "x", ignore, 1, event_callbacks=callbacks)
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        node.create_publisher(Int32, "x", qos_profile_sensor_data, event_callbacks=quiet)
        graph.run_due()
        assert matched == []
        assert [(e.last_policy_kind, e.total_count) for e in refused] == [(QoSPolicyKind.RELIABILITY, 1)]


def test_a_wrong_type_is_an_event_too(graph: Graph, node: Node, lines: list[LogRecord]) -> None:
    events: list[Any] = []
    node.create_subscription(
        Int32, "x", ignore, 1, event_callbacks=SubscriptionEventCallbacks(incompatible_type=events.append)
    )
    node.create_publisher(
        String, "x", 1, event_callbacks=PublisherEventCallbacks(incompatible_type=events.append)
    )
    graph.run_due()
    assert [(event.total_count, event.total_count_change) for event in events] == [(1, 1), (1, 1)]
    assert lines == []


def test_a_callback_that_takes_no_status_is_refused_at_once(node: Node) -> None:
    with pytest.raises(TypeError, match="matched"):
        node.create_publisher(Int32, "x", 1, event_callbacks=PublisherEventCallbacks(matched=lambda: None))


class TestDeadline:
    QOS = QoSProfile(depth=1, deadline=Duration(nanoseconds=100 * MS))

    def run(self, graph: Graph, until_ms: int) -> None:
        for now in range(graph.now_ns // MS + 10, until_ms + 1, 10):
            graph.advance(now * MS)
            graph.run_due()

    def test_both_ends_hear_of_messages_that_do_not_come(self, graph: Graph, node: Node) -> None:
        offered: list[Any] = []
        requested: list[Any] = []
        publisher = node.create_publisher(
            Int32, "x", self.QOS, event_callbacks=PublisherEventCallbacks(deadline=offered.append)
        )
        node.create_subscription(
            Int32,
            "x",
            ignore,
            self.QOS,
            event_callbacks=SubscriptionEventCallbacks(deadline=requested.append),
        )
        self.run(graph, 500)
        assert offered == requested == []  # a deadline begins with the first message
        publisher.publish(Int32())
        self.run(graph, 590)
        publisher.publish(Int32())
        self.run(graph, 680)
        assert offered == requested == []
        self.run(graph, 900)
        assert [e.total_count for e in offered] == [e.total_count for e in requested] == [1, 2, 3]
        publisher.destroy()
        self.run(graph, 1200)
        assert len(offered) == 3
        assert len(requested) == 6

    def test_it_goes_on_after_a_jump_back_in_time(self, graph: Graph, node: Node) -> None:
        missed: list[Any] = []
        publisher = node.create_publisher(
            Int32, "x", self.QOS, event_callbacks=PublisherEventCallbacks(deadline=missed.append)
        )
        self.run(graph, 1000)
        publisher.publish(Int32())
        graph.advance(0)
        self.run(graph, 100)
        assert len(missed) == 1


class TestLiveliness:
    QOS = QoSProfile(
        depth=1,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(nanoseconds=100 * MS),
    )

    def test_a_publisher_is_alive_while_it_shows_so(self, graph: Graph, node: Node) -> None:
        lost: list[Any] = []
        seen: list[Any] = []
        publisher = node.create_publisher(
            Int32, "x", self.QOS, event_callbacks=PublisherEventCallbacks(liveliness=lost.append)
        )
        node.create_subscription(
            Int32,
            "x",
            ignore,
            self.QOS,
            event_callbacks=SubscriptionEventCallbacks(
                liveliness=lambda event: seen.append((graph.now_ns // MS, *event))
            ),
        )
        for now in range(0, 700, 10):
            graph.advance(now * MS)
            if now == 50:
                publisher.publish(Int32())
            if now in (120, 400):
                publisher.assert_liveliness()
            graph.run_due()
        assert seen == [(50, 1, 0, 1, 0), (220, 0, 1, -1, 1), (400, 1, 0, 1, -1), (500, 0, 1, -1, 1)]
        assert [event.total_count for event in lost] == [1, 2]


def test_a_later_subscription_gets_no_message_whose_lifespan_has_passed(graph: Graph, node: Node) -> None:
    kept = QoSProfile(
        depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(nanoseconds=100 * MS)
    )
    publisher = node.create_publisher(Int32, "x", kept)
    heard: list[int] = []
    for number in range(4):
        graph.advance(number * 40 * MS)
        publisher.publish(Int32(data=number))
    node.create_subscription(Int32, "x", lambda message: heard.append(message.data), kept)
    graph.run_due()
    assert heard == [1, 2, 3]


def test_a_raw_subscription_gets_bytes_which_can_be_published(graph: Graph, node: Node) -> None:
    raw: list[bytes] = []
    read: list[Int32] = []
    node.create_subscription(Int32, "x", raw.append, 1, raw=True)
    node.create_subscription(Int32, "y", read.append, 1)
    node.create_publisher(Int32, "x", 1).publish(Int32(data=7))
    graph.run_due()
    assert raw == [bytes([0, 1, 0, 0, 7, 0, 0, 0])]
    node.create_publisher(Int32, "y", 1).publish(raw[0])
    graph.run_due()
    assert read == [Int32(data=7)]
