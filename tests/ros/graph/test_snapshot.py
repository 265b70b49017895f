"""Who is in a graph, as data: names, ends, what does not match, and when it is the same as before."""

from __future__ import annotations

from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.ros.graph.graph import Graph
from kit.ros.graph.snapshot import EndpointState, snapshot
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
