"""Publishing and subscribing: copies, queues, quality of service, and mistakes."""

from __future__ import annotations

import itertools
from typing import Any

import pytest

from kit.msg.fields import FieldError
from kit.msg.geometry_msgs import Pose, PoseArray, Twist
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Int32, String
from kit.msg.std_srvs import Trigger
from kit.ros.exceptions import InvalidHandle, InvalidTopicNameException
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.events import PublisherEventCallbacks, SubscriptionEventCallbacks
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSCompatibility,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
    qos_profile_sensor_data,
)
from kit.ros.node.qos import InvalidQoSProfileException as BadProfile
from kit.ros.node.time import Duration


@pytest.fixture
def node(graph: Graph) -> Node:
    return create_graph_node(graph, "node")


class TestCopies:
    """What ROS 2 guarantees by sending messages over a network."""

    def test_a_message_can_be_changed_and_published_again(self, graph: Graph, node: Node) -> None:
        heard: list[int] = []
        publisher = node.create_publisher(Int32, "x", 10)
        node.create_subscription(Int32, "x", lambda message: heard.append(message.data), 10)
        message = Int32()
        for message.data in range(3):
            publisher.publish(message)
        graph.run_due()
        assert heard == [0, 1, 2]

    @pytest.mark.parametrize("send", ["publish", "publish_without_copy"])
    def test_subscriptions_do_not_see_each_others_changes(self, graph: Graph, node: Node, send: str) -> None:
        heard: list[LaserScan] = []

        def spoil(scan: LaserScan) -> None:
            heard.append(scan)
            scan.ranges[0] = 9.0
            scan.header.frame_id = "spoilt"

        publisher = node.create_publisher(LaserScan, "scan", 10)
        node.create_subscription(LaserScan, "scan", spoil, 10)
        clean: list[LaserScan] = []
        node.create_subscription(LaserScan, "scan", clean.append, 10)
        original = LaserScan(ranges=[1.0])
        getattr(publisher, send)(original)
        graph.run_due()
        assert clean == [LaserScan(ranges=[1.0])]
        assert heard[0] is not clean[0]
        if send == "publish":
            assert original == LaserScan(ranges=[1.0])

    def test_a_message_handed_over_is_not_copied_for_its_only_reader(self, graph: Graph, node: Node) -> None:
        heard: list[LaserScan] = []
        node.create_subscription(LaserScan, "scan", heard.append, 10)
        scan = LaserScan()
        node.create_publisher(LaserScan, "scan", 10).publish_without_copy(scan)
        graph.run_due()
        assert heard[0] is scan


class TestQueues:
    def test_a_full_queue_drops_its_oldest(self, graph: Graph, node: Node) -> None:
        heard: list[int] = []
        publisher = node.create_publisher(Int32, "x", 10)
        node.create_subscription(Int32, "x", lambda message: heard.append(message.data), 3)
        for number in range(10):
            publisher.publish(Int32(data=number))
        assert graph.run_due() == 3
        assert heard == [7, 8, 9]

    def test_a_full_queue_does_not_hold_up_the_line(self, graph: Graph, node: Node) -> None:
        publisher = node.create_publisher(Int32, "x", 10)
        node.create_subscription(Int32, "x", lambda message: None, 2)
        for number in range(100):
            publisher.publish(Int32(data=number))
        assert len(graph.ready_queue.items) == 2

    def test_keep_all_keeps_all(self, graph: Graph, node: Node) -> None:
        heard: list[int] = []
        publisher = node.create_publisher(Int32, "x", 1)
        everything = QoSProfile(history=HistoryPolicy.KEEP_ALL)
        node.create_subscription(Int32, "x", lambda message: heard.append(message.data), everything)
        for number in range(50):
            publisher.publish(Int32(data=number))
        graph.run_due()
        assert heard == list(range(50))

    def test_latecomers_hear_what_a_transient_local_publisher_kept(self, graph: Graph, node: Node) -> None:
        latched = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        publisher = node.create_publisher(Int32, "map", latched)
        for number in range(5):
            publisher.publish(Int32(data=number))
        late: list[int] = []
        volatile: list[int] = []
        node.create_subscription(Int32, "map", lambda message: late.append(message.data), latched)
        node.create_subscription(Int32, "map", lambda message: volatile.append(message.data), 10)
        graph.run_due()
        assert (late, volatile) == ([3, 4], [])

    def test_a_subscription_destroyed_in_between_hears_nothing(self, graph: Graph, node: Node) -> None:
        publisher = node.create_publisher(Int32, "x", 10)
        subscription = node.create_subscription(Int32, "x", lambda message: pytest.fail("destroyed"), 10)
        publisher.publish(Int32())
        assert node.destroy_subscription(subscription)
        assert not node.destroy_subscription(subscription)
        graph.run_due()


def offers(**settings: Any) -> QoSProfile:
    return QoSProfile(depth=10, **settings)


class TestQualityOfService:
    @pytest.mark.parametrize(
        ("offered", "asked", "policy"),
        [
            (offers(reliability=ReliabilityPolicy.BEST_EFFORT), offers(), "RELIABILITY"),
            (offers(), offers(durability=DurabilityPolicy.TRANSIENT_LOCAL), "DURABILITY"),
            (offers(), offers(deadline=Duration(seconds=1)), "DEADLINE"),
            (offers(), offers(liveliness=LivelinessPolicy.MANUAL_BY_TOPIC), "LIVELINESS"),
        ],
    )
    @pytest.mark.parametrize("publisher_first", [True, False])
    def test_too_little_offered_means_no_data_and_a_warning_naming_the_policy(
        self,
        graph: Graph,
        lines: list[LogRecord],
        offered: QoSProfile,
        asked: QoSProfile,
        policy: str,
        publisher_first: bool,
    ) -> None:
        talker, listener = create_graph_node(graph, "talker"), create_graph_node(graph, "listener")
        heard: list[Int32] = []
        make = [
            lambda: talker.create_publisher(Int32, "x", offered),
            lambda: listener.create_subscription(Int32, "x", heard.append, asked),
        ]
        made: list[Any] = [step() for step in (make if publisher_first else make[::-1])]
        publisher = made[0 if publisher_first else 1]
        publisher.publish(Int32())
        graph.run_due()
        assert heard == []
        assert publisher.get_subscription_count() == 0
        warnings = {line.name: line.text for line in lines if "incompatible QoS" in line.text}
        assert warnings.keys() == {"talker", "listener"}
        assert all(f"Last incompatible policy: {policy}" in text for text in warnings.values())
        assert "requesting incompatible QoS. No messages will be sent to it" in warnings["talker"]
        assert "offering incompatible QoS. No messages will be received from it" in warnings["listener"]
        assert qos_check_compatible(offered, asked)[0] is not QoSCompatibility.OK

    @pytest.mark.parametrize(
        ("offered", "asked", "outcome", "reason"),
        [
            (
                qos_profile_sensor_data,
                offers(durability=DurabilityPolicy.TRANSIENT_LOCAL, deadline=Duration(seconds=1)),
                QoSCompatibility.ERROR,
                (
                    "ERROR: Best effort publisher and reliable subscription;"
                    "ERROR: Volatile publisher and transient local subscription;"
                    "ERROR: Subscription has a deadline, but publisher does not;"
                ),
            ),
            (
                offers(liveliness_lease_duration=Duration(seconds=2)),
                offers(liveliness_lease_duration=Duration(seconds=1)),
                QoSCompatibility.ERROR,
                "ERROR: Subscription liveliness lease duration is less than publisher;",
            ),
            (
                offers(),
                offers(),
                QoSCompatibility.WARNING,
                "WARNING: Publisher liveliness is system_default and subscription liveliness is system_default;",
            ),
            (
                offers(liveliness=LivelinessPolicy.AUTOMATIC, reliability=ReliabilityPolicy.UNKNOWN),
                offers(liveliness=LivelinessPolicy.AUTOMATIC),
                QoSCompatibility.WARNING,
                "WARNING: Reliable subscription, but publisher is unknown;",
            ),
            (
                offers(liveliness=LivelinessPolicy.AUTOMATIC),
                offers(liveliness=LivelinessPolicy.AUTOMATIC),
                QoSCompatibility.OK,
                "",
            ),
        ],
    )
    def test_every_reason_against_two_profiles_is_told(
        self, offered: QoSProfile, asked: QoSProfile, outcome: QoSCompatibility, reason: str
    ) -> None:
        assert qos_check_compatible(offered, asked) == (outcome, reason)

    def test_more_offered_than_asked_is_fine(self, graph: Graph, lines: list[LogRecord], node: Node) -> None:
        heard: list[Int32] = []
        node.create_subscription(Int32, "x", heard.append, qos_profile_sensor_data)
        node.create_publisher(Int32, "x", 10).publish(Int32())
        graph.run_due()
        assert len(heard) == 1
        assert lines == []

    def test_an_event_callback_takes_the_warnings_place(
        self, graph: Graph, lines: list[LogRecord], node: Node
    ) -> None:
        events: list[Any] = []
        node.create_subscription(
            Int32, "x", print, 10, event_callbacks=SubscriptionEventCallbacks(incompatible_qos=events.append)
        )
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        node.create_publisher(Int32, "x", qos_profile_sensor_data, event_callbacks=quiet)
        graph.run_due()
        assert [event.last_policy_kind for event in events] == [QoSPolicyKind.RELIABILITY]
        assert lines == []

    @pytest.mark.parametrize(
        ("wrong", "error"),
        [(-1, ValueError), ("10", TypeError), (None, TypeError), (True, TypeError), (1.0, TypeError)],
    )
    def test_a_profile_is_a_profile_or_a_depth(self, node: Node, wrong: Any, error: type[Exception]) -> None:
        with pytest.raises(error):
            node.create_publisher(Int32, "x", wrong)
        with pytest.raises(error):
            node.create_subscription(Int32, "x", print, wrong)

    def test_it_must_not_be_left_out(self, node: Node) -> None:
        with pytest.raises(TypeError):
            node.create_publisher(Int32, "x")

    @pytest.mark.parametrize(
        ("settings", "error"),
        [
            ({}, BadProfile),
            ({"history": HistoryPolicy.KEEP_LAST}, BadProfile),
            ({"depth": -1}, ValueError),
            ({"depth": "5"}, TypeError),
            ({"depht": 5}, AssertionError),
            ({"depth": 5, "reliability": "reliable"}, TypeError),
            ({"depth": 5, "reliability": 77}, ValueError),
        ],
    )
    def test_a_profile_is_checked(self, settings: dict[str, Any], error: type[Exception]) -> None:
        with pytest.raises(error):
            QoSProfile(**settings)

    def test_policies_have_short_keys(self) -> None:
        assert ReliabilityPolicy.get_from_short_key("best_effort") is ReliabilityPolicy.BEST_EFFORT
        assert DurabilityPolicy.TRANSIENT_LOCAL.short_key == "transient_local"
        assert "keep_last" in HistoryPolicy.short_keys()


class TestMistakes:
    def test_two_types_on_one_topic_are_reported_to_both(self, graph: Graph, lines: list[LogRecord]) -> None:
        talker, listener = create_graph_node(graph, "talker"), create_graph_node(graph, "listener")
        heard: list[Any] = []
        listener.create_subscription(String, "x", heard.append, 10)
        talker.create_publisher(Int32, "x", 10).publish(Int32())
        graph.run_due()
        assert heard == []
        assert {line.name for line in lines} == {"talker", "listener"}
        assert all("/talker publishes std_msgs/msg/Int32" in line.text for line in lines)

    @pytest.mark.parametrize("wrong", ["text", 5, None, Twist(), Twist])
    def test_only_its_own_messages_can_be_published(self, node: Node, wrong: Any) -> None:
        with pytest.raises(TypeError, match="'/x'"):
            node.create_publisher(String, "x", 10).publish(wrong)

    def test_the_class_instead_of_a_message_is_pointed_out(self, node: Node) -> None:
        with pytest.raises(TypeError, match=r"write String\(\)"):
            node.create_publisher(String, "x", 10).publish(String)

    def test_a_message_spoilt_from_within_is_refused_with_the_place(self, node: Node) -> None:
        node.create_subscription(PoseArray, "x", print, 10)
        spoilt = PoseArray(poses=[Pose()])
        spoilt.poses.append("here")
        with pytest.raises(FieldError, match=r"poses\[1\]"):
            node.create_publisher(PoseArray, "x", 10).publish(spoilt)

    @pytest.mark.parametrize("wrong", ["std_msgs/String", Trigger, int, String(), itertools, None])
    def test_a_message_class_is_needed(self, node: Node, wrong: Any) -> None:
        with pytest.raises(TypeError, match="a message class is needed"):
            node.create_publisher(wrong, "x", 10)
        with pytest.raises(TypeError, match="a message class is needed"):
            node.create_subscription(wrong, "x", print, 10)

    def test_a_callback_called_instead_of_given_is_pointed_out(self, node: Node) -> None:
        with pytest.raises(TypeError, match="without parentheses"):
            node.create_subscription(String, "x", None, 10)

    def test_a_callback_with_the_wrong_number_of_parameters_shows_at_once(self, node: Node) -> None:
        with pytest.raises(TypeError, match="called with 1 or 2 argument"):
            node.create_subscription(String, "x", lambda: None, 10)

    def test_a_callback_may_have_more_parameters_with_defaults(self, graph: Graph, node: Node) -> None:
        heard: list[Any] = []
        for robot in ("left", "right"):
            node.create_subscription(String, "x", lambda message, robot=robot: heard.append(robot), 10)
        node.create_publisher(String, "x", 10).publish(String())
        graph.run_due()
        assert heard == ["left", "right"]

    def test_a_second_parameter_gets_the_messages_circumstances(self, graph: Graph, node: Node) -> None:
        heard: list[Any] = []
        graph.advance(7)
        node.create_subscription(
            String, "x", lambda message, info: heard.append(info["received_timestamp"]), 10
        )
        node.create_publisher(String, "x", 10).publish(String())
        graph.run_due()
        assert heard == [7]

    @pytest.mark.parametrize("name", ["", "a//b", "1st", "a/1st", "a b", "a-b", "a/", "x~", "~x", "{node"])
    def test_a_topic_name_must_be_one(self, node: Node, name: str) -> None:
        with pytest.raises(InvalidTopicNameException):
            node.create_publisher(String, name, 10)

    def test_what_is_destroyed_cannot_be_used(self, node: Node) -> None:
        publisher = node.create_publisher(String, "x", 10)
        publisher.destroy()
        with pytest.raises(InvalidHandle):
            publisher.publish(String())
        node.destroy_node()
        with pytest.raises(InvalidHandle):
            node.create_publisher(String, "x", 10)


def test_publishers_subscriptions_and_nodes_find_each_other(graph: Graph) -> None:
    node = create_graph_node(graph, "node", "/robot")
    publisher = node.create_publisher(String, "chat", 10)
    subscription = node.create_subscription(String, "chat", print, 10)
    assert (publisher.topic_name, publisher.get_subscription_count()) == ("/robot/chat", 1)
    assert subscription.get_publisher_count() == 1
    assert graph.subscription_count("/robot/chat") == 1
    assert publisher in list(node.publishers)
    assert list(node.subscriptions) == [subscription]
    assert publisher.wait_for_all_acked()


def test_looking_around(graph: Graph) -> None:
    talker, listener = create_graph_node(graph, "talker"), create_graph_node(graph, "listener", "/far")
    talker.create_publisher(String, "chat", 7)
    listener.create_subscription(String, "/chat", print, 10)
    listener.create_service(Trigger, "ask", lambda request, response: response)
    talker.create_client(Trigger, "/far/ask")
    assert listener.get_node_names_and_namespaces() == [("talker", "/"), ("listener", "/far")]
    assert ("/chat", ["std_msgs/msg/String"]) in listener.get_topic_names_and_types()
    assert ("/far/ask", ["std_srvs/srv/Trigger"]) in talker.get_service_names_and_types()
    assert ("/chat", ["std_msgs/msg/String"]) in listener.get_publisher_names_and_types_by_node("talker", "/")
    assert talker.get_subscriber_names_and_types_by_node("listener", "/far") == [
        ("/chat", ["std_msgs/msg/String"])
    ]
    assert talker.get_client_names_and_types_by_node("talker", "/") == [
        ("/far/ask", ["std_srvs/srv/Trigger"])
    ]
    assert ("/far/ask", ["std_srvs/srv/Trigger"]) in talker.get_service_names_and_types_by_node(
        "listener", "/far"
    )
    assert (talker.count_publishers("chat"), listener.count_subscribers("/chat")) == (1, 1)
    (info,) = listener.get_publishers_info_by_topic("/chat")
    assert (info.node_name, info.topic_type, info.qos_profile.depth) == ("talker", "std_msgs/msg/String", 7)
    assert info.endpoint_type.name == "PUBLISHER"
    assert len(info.endpoint_gid) == 16
    with pytest.raises(RuntimeError, match="there is no node 'x'"):
        talker.get_publisher_names_and_types_by_node("x", "/")
