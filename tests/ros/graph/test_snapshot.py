"""Who is in a graph, as data: names, ends, what does not match, and when it is the same as before."""

from __future__ import annotations

import pytest

from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Int32, String
from kit.msg.std_srvs import Trigger
from kit.ros.graph.graph import Graph
from kit.ros.graph.snapshot import EndpointState, snapshot
from kit.ros.graph.topic_statistics import HISTORY, MessageFlow, TopicStats
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import qos_profile_sensor_data


def test_nodes_topics_and_services_with_their_ends(graph: Graph) -> None:
    talker, listener = (
        create_graph_node(graph, "talker"),
        create_graph_node(graph, "listener", namespace="/house"),
    )
    talker.create_publisher(String, "words", 10)
    listener.create_subscription(String, "/words", print, 5)
    listener.create_service(Trigger, "/ring", lambda request, response: response)
    talker.create_client(Trigger, "/ring")
    talker.create_client(Trigger, "/nobody")
    state = snapshot(graph)
    assert state.nodes == ("/talker", "/house/listener")
    words = next(topic for topic in state.topics if topic.name == "/words")
    assert [end.node for end in words.publishers] == ["/talker"]
    assert [(end.node, end.qos.depth) for end in words.subscriptions] == [("/house/listener", 5)]
    assert words.types == ("std_msgs/msg/String",)
    assert words.mismatches == ()
    services = {service.name: service for service in state.services}
    assert services["/ring"].servers == ("/house/listener",)
    assert services["/ring"].clients == ("/talker",)
    assert services["/nobody"].servers == ()


def test_what_ros_needs_for_itself_is_known_as_such(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    node.create_publisher(String, "words", 10)
    node.create_service(Trigger, "/other/get_parameters", lambda request, response: response)
    state = snapshot(graph)
    assert {topic.name for topic in state.topics if not topic.is_infrastructure} == {"/words"}
    assert {service.name for service in state.services if not service.is_infrastructure} == {
        "/other/get_parameters"
    }


def test_ends_that_do_not_go_together_are_named_with_the_policy(graph: Graph) -> None:
    robot, student = create_graph_node(graph, "robot"), create_graph_node(graph, "student")
    robot.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
    student.create_subscription(LaserScan, "scan", print, 10)
    student.create_subscription(String, "scan", print, 10)
    scan = next(topic for topic in snapshot(graph).topics if topic.name == "/scan")
    policy, types = scan.mismatches
    assert (policy.publisher, policy.subscription) == ("/robot", "/student")
    assert policy.reason.startswith("RELIABILITY")
    assert "BEST_EFFORT" in policy.reason
    assert "std_msgs/msg/String" in types.reason


def test_nodes_of_one_name_count_once(graph: Graph) -> None:
    for _ in range(2):
        create_graph_node(graph, "twin").create_publisher(String, "words", 10)
    state = snapshot(graph)
    assert state.nodes == ("/twin",)
    words = next(topic for topic in state.topics if topic.name == "/words")
    assert words.publishers == (EndpointState("/twin", "std_msgs/msg/String", words.publishers[0].qos),) * 2


def test_the_version_changes_with_whatever_comes_or_goes(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    versions = [snapshot(graph).version]
    assert snapshot(graph).version == versions[0]
    publisher = node.create_publisher(String, "words", 10)
    versions.append(snapshot(graph).version)
    publisher.publish(String())
    assert snapshot(graph).version == versions[1]
    node.destroy_publisher(publisher)
    versions.append(snapshot(graph).version)
    node.destroy_node()
    versions.append(snapshot(graph).version)
    assert len(set(versions)) == len(versions)
    assert snapshot(graph).nodes == ()


MS = 1_000_000
WORDS = MessageFlow("/talker", "/words")


def speak(graph: Graph, times: int, period_ms: int) -> None:
    """So many words by ``/talker``, at this period."""
    if not any(node.get_name() == "talker" for node in graph.nodes):
        create_graph_node(graph, "talker").create_publisher(String, "words", 10)
    publisher = next(end for node in graph.nodes for end in node.publishers if end.topic_name == "/words")
    for number in range(times):
        graph.advance(graph.now_ns + period_ms * MS)
        publisher.publish(String(data=str(number)))


def test_a_rate_is_that_of_the_graphs_time(graph: Graph) -> None:
    stats = TopicStats(graph)
    speak(graph, 1, 50)
    assert stats.flow_stats()[WORDS].rate is None
    speak(graph, 20, 50)
    said = stats.flow_stats()[WORDS]
    assert said.count == 21
    assert said.rate == pytest.approx(20.0)
    speak(graph, 100, 200)
    assert stats.flow_stats()[WORDS].rate == pytest.approx(5.0)


def test_a_rate_ends_when_it_has_been_silent_for_a_while_and_survives_a_pause(graph: Graph) -> None:
    stats = TopicStats(graph)
    speak(graph, 10, 100)
    for _ in range(2):  # as long as time stands still, so does the rate
        assert stats.flow_stats()[WORDS].rate == pytest.approx(10.0)
    graph.advance(graph.now_ns + 3100 * MS)
    assert stats.flow_stats()[WORDS].rate is None
    assert stats.flow_stats()[WORDS].count == 10
    speak(graph, 3, 20_000)
    assert stats.flow_stats()[WORDS].rate is not None


def test_a_slow_flow_is_not_taken_for_a_silent_one(graph: Graph) -> None:
    stats = TopicStats(graph)
    speak(graph, 3, 5000)
    graph.advance(graph.now_ns + 9000 * MS)
    assert stats.flow_stats()[WORDS].rate == pytest.approx(0.2)


def test_a_reset_of_the_time_starts_the_rates_anew(graph: Graph) -> None:
    stats = TopicStats(graph)
    speak(graph, 10, 100)
    graph.advance(0)
    assert stats.flow_stats()[WORDS].rate is None
    speak(graph, 10, 25)
    assert stats.flow_stats()[WORDS].rate == pytest.approx(40.0)


def test_questions_and_answers_name_who_asked(graph: Graph) -> None:
    server = create_graph_node(graph, "server")
    server.create_service(Trigger, "/ring", lambda request, response: response)
    clients = [create_graph_node(graph, name).create_client(Trigger, "/ring") for name in ("anna", "bert")]
    stats = TopicStats(graph)
    for client in (clients[1], clients[0], clients[1]):
        client.call_async(Trigger.Request())
        graph.run_due()
    counts = {flow: said.count for flow, said in stats.flow_stats().items()}
    assert counts == {
        MessageFlow("/anna", "/ring", is_service=True): 1,
        MessageFlow("/bert", "/ring", is_service=True): 2,
        MessageFlow("/server", "/ring", is_service=True, response_to="/anna"): 1,
        MessageFlow("/server", "/ring", is_service=True, response_to="/bert"): 2,
    }


def test_the_newest_message_of_the_chosen_topic_is_a_copy(graph: Graph) -> None:
    publisher = create_graph_node(graph, "talker").create_publisher(String, "words", 10)
    stats = TopicStats(graph)
    publisher.publish(String(data="before"))
    stats.select("/words")
    assert stats.latest_message is None
    message = String(data="after")
    publisher.publish(message)
    message.data = "changed by the sender"
    assert stats.latest_message == String(data="after")
    stats.select("/words")
    assert stats.latest_message == String(data="after")
    stats.select("/others")
    assert stats.latest_message is None


def test_the_history_holds_the_last_numbers_of_the_chosen_topic(graph: Graph) -> None:
    publisher = create_graph_node(graph, "counter").create_publisher(Int32, "count", HISTORY + 10)
    stats = TopicStats(graph)
    publisher.publish(Int32(data=-1))
    stats.select("/count")
    assert stats.history() == ()
    for number in range(HISTORY + 5):
        graph.advance(graph.now_ns + MS)
        publisher.publish(Int32(data=number))
    assert [sample.values["data"] for sample in stats.history()] == list(range(5, HISTORY + 5))
    assert stats.history()[-1].time_ns - stats.history()[0].time_ns == (HISTORY - 1) * MS
    graph.advance(0)
    publisher.publish(Int32(data=7))
    assert [sample.values["data"] for sample in stats.history()] == [7]
    stats.select("/others")
    assert stats.history() == ()


def test_nothing_is_heard_after_the_stop(graph: Graph) -> None:
    stats = TopicStats(graph)
    speak(graph, 2, 100)
    stats.stop()
    assert graph.message_listeners == ()
    speak(graph, 2, 100)
    assert stats.flow_stats()[WORDS].count == 2
