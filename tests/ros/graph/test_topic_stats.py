"""Listening in: counts, rates in the graph's time, questions and answers, the newest message."""

from __future__ import annotations

import pytest

from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.ros.graph.graph import Graph
from kit.ros.graph.snapshot import MessageFlow, TopicStats
from kit.ros.node.node import create_graph_node

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


def test_nothing_is_heard_after_the_stop(graph: Graph) -> None:
    stats = TopicStats(graph)
    speak(graph, 2, 100)
    stats.stop()
    assert graph.message_listeners == ()
    speak(graph, 2, 100)
    assert stats.flow_stats()[WORDS].count == 2
