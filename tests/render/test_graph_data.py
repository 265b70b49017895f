"""What of a graph is worth showing."""

from __future__ import annotations

import pytest

from kit.msg.example_interfaces import Fibonacci
from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.render.graph_data import build_graph_data
from kit.ros.action.client import ActionClient
from kit.ros.action.server import ActionServer
from kit.ros.graph.graph import Graph
from kit.ros.graph.snapshot import GraphState, snapshot
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import qos_profile_sensor_data


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
