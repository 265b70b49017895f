"""What of a graph is worth showing."""

from __future__ import annotations

import math

import pytest
import yaml

from kit.msg.conversion import to_dict
from kit.msg.example_interfaces import Fibonacci
from kit.msg.flatland_msgs import Collision, Collisions
from kit.msg.geometry_msgs import Twist
from kit.msg.message import Message
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Float32, String
from kit.msg.std_srvs import Empty, SetBool, Trigger
from kit.render.graph_data import MAX_NUMBER_ROWS, build_graph_data, message_rows
from kit.ros.action.client import ActionClient
from kit.ros.action.server import ActionServer
from kit.ros.graph.graph import Graph
from kit.ros.graph.snapshot import GraphState, snapshot
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import qos_profile_sensor_data
from tests.cases import every_case


@pytest.fixture
def state() -> GraphState:
    graph = Graph(log_sink=lambda record: None)
    talker, listener = create_graph_node(graph, "talker"), create_graph_node(graph, "listener")
    talker.create_publisher(String, "words", qos_profile_sensor_data)
    listener.create_subscription(String, "words", print, 10)
    listener.create_service(Trigger, "used", lambda request, response: response)
    listener.create_service(Trigger, "unused", lambda request, response: response)
    talker.create_client(Trigger, "used")
    return snapshot(graph)


def test_what_ros_needs_for_itself_and_what_nobody_asks_is_hidden(state: GraphState) -> None:
    shown = build_graph_data(state)
    assert [item.label for item in shown.items] == ["/words", "/used()"]
    assert shown.hidden_count == 1 + 2 * 6 + 2  # a service, parameter services, /rosout and /parameter_events
    everything = build_graph_data(state, show_all=True)
    assert everything.hidden_count == 0
    assert len(everything.items) == 2 + shown.hidden_count


def test_a_line_on_which_nothing_arrives_is_broken(state: GraphState) -> None:
    words = build_graph_data(state).items[0]
    assert words.undelivered == {("/talker", "/listener")}


def test_narrowing_keeps_what_is_joined_to_the_name(state: GraphState) -> None:
    by_topic = build_graph_data(state, name_filter="WORD")
    assert [item.label for item in by_topic.items] == ["/words"]
    assert by_topic.nodes == ("/talker", "/listener")
    assert build_graph_data(state, name_filter="talker").items == build_graph_data(state).items
    assert build_graph_data(state, name_filter="nothing of that name").nodes == ()


def test_a_node_without_anything_to_say_is_there_all_the_same() -> None:
    graph = Graph(log_sink=lambda record: None)
    create_graph_node(graph, "silent")
    assert build_graph_data(snapshot(graph)).nodes == ("/silent",)


def test_an_action_shows_its_goals_results_and_feedback() -> None:
    graph = Graph(log_sink=lambda record: None)
    ActionServer(create_graph_node(graph, "arm"), Fibonacci, "wave", lambda goal_handle: Fibonacci.Result())
    ActionClient(create_graph_node(graph, "brain"), Fibonacci, "wave")
    shown = build_graph_data(snapshot(graph))
    assert [(item.label, item.senders, item.receivers) for item in shown.items] == [
        ("/wave/_action/feedback", ("/arm",), ("/brain",)),
        ("/wave/_action/get_result()", ("/brain",), ("/arm",)),
        ("/wave/_action/send_goal()", ("/brain",), ("/arm",)),
    ]


def twist() -> Twist:
    message = Twist()
    message.linear.x, message.angular.z = 0.5, -1.25
    return message


def test_a_twist_as_ros_echoes_it() -> None:
    assert message_rows(twist(), 80) == [
        "linear:",
        "  x: 0.5",
        "  y: 0.0",
        "  z: 0.0",
        "angular:",
        "  x: 0.0",
        "  y: 0.0",
        "  z: -1.25",
    ]


def test_a_compact_twist_takes_two_rows() -> None:
    assert message_rows(twist(), 80, compact=True) == [
        "linear: {x: 0.5, y: 0.0, z: 0.0}",
        "angular: {x: 0.0, y: 0.0, z: -1.25}",
    ]


@every_case("compact", [False, True])
@every_case(
    "message",
    [
        twist(),
        LaserScan(ranges=[1.5, math.inf, 0.25]),
        String(data="p_up"),
        String(data=""),
        String(data="yes: no # 'maybe'"),
        String(data="true"),
        Float32(data=math.nan),
        SetBool.Request(data=True),
        Empty.Request(),
        Collisions(collisions=[Collision(entity_a="robot", entity_b="wall"), Collision(entity_a="other")]),
    ],
    ids=lambda message: type(message).__name__ if isinstance(message, Message) else str(message),
)
def test_it_is_yaml_of_the_same_values(message: Message, compact: bool) -> None:
    read = yaml.safe_load("\n".join(message_rows(message, 200, compact=compact)))
    assert repr(read) == repr(to_dict(message))


def test_long_lists_are_cut_with_their_length() -> None:
    scan = LaserScan(ranges=[float(number) for number in range(91)])
    rows = message_rows(scan, 60)
    assert max(map(len, rows)) <= 60
    first = next(number for number, row in enumerate(rows) if row.startswith("ranges"))
    ranges = rows[first : first + MAX_NUMBER_ROWS]
    assert ranges[0].startswith("ranges: [0.0, 1.0, ")
    assert ranges[-1].endswith(" ... 91 in all]")
    assert rows[first + MAX_NUMBER_ROWS] == "intensities: []"


@pytest.mark.parametrize("width", [8, 20, 40])
def test_no_row_is_wider_than_asked(width: int) -> None:
    for compact in (False, True):
        assert max(map(len, message_rows(twist(), width, compact=compact))) <= width
