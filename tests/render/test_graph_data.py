"""What of a graph is worth showing."""

from __future__ import annotations

import pytest

from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.render.graph_data import conversation
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
    shown = conversation(state)
    assert [item.label for item in shown.items] == ["/words", "/used()"]
    assert shown.hidden == 1 + 2 * 6 + 2  # a service, parameter services, /rosout and /parameter_events
    everything = conversation(state, everything=True)
    assert everything.hidden == 0
    assert len(everything.items) == 2 + shown.hidden


def test_a_line_on_which_nothing_arrives_is_broken(state: GraphState) -> None:
    words = conversation(state).items[0]
    assert words.broken == {("/talker", "/listener")}


def test_narrowing_keeps_what_is_joined_to_the_name(state: GraphState) -> None:
    by_topic = conversation(state, narrowed="WORD")
    assert [item.label for item in by_topic.items] == ["/words"]
    assert by_topic.nodes == ("/talker", "/listener")
    assert conversation(state, narrowed="talker").items == conversation(state).items
    assert conversation(state, narrowed="nothing of that name").nodes == ()


def test_a_node_without_anything_to_say_is_there_all_the_same() -> None:
    graph = Graph(log_sink=lambda record: None)
    create_graph_node(graph, "silent")
    assert conversation(snapshot(graph)).nodes == ("/silent",)
