"""Proxies of a program's nodes: how many it may have, and how many it may make one after the other."""

from __future__ import annotations

from typing import Any

import pytest

from kit.host import proxy_nodes
from kit.host.proxy_nodes import GraphDiff, ProxyNodes
from kit.host.wire import MAX_NAME, ProtocolError
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import QoSProfile


class NobodyListens:
    def on_message(self, subscription: int, message: Any) -> None: ...

    def on_request(self, service: int, call: Any) -> None: ...

    def on_response(self, client: int, number: int, response: Any) -> None: ...

    def on_discard(self, endpoint: int) -> None: ...


@pytest.fixture
def proxies() -> ProxyNodes:
    made = ProxyNodes(Graph(log_sink=lambda record: None), NobodyListens())
    made.apply_event("node", [1, "talker", "/"])
    return made


def add_publisher(proxies: ProxyNodes, number: int) -> None:
    proxies.apply_event(
        "publisher", [number, 1, f"/topic{number}", "std_msgs/msg/String", QoSProfile(depth=10).numbers]
    )


def test_too_many_at_once_are_refused(proxies: ProxyNodes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proxy_nodes, "MAX_ENDPOINTS", 4)
    for number in range(2, 5):
        add_publisher(proxies, number)
    with pytest.raises(ProtocolError, match="more than 4 nodes"):
        add_publisher(proxies, 5)


def test_too_many_one_after_the_other_are_refused(
    proxies: ProxyNodes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each is gone when the next one comes, but its name is remembered by whoever watches the graph."""
    monkeypatch.setattr(proxy_nodes, "MAX_MADE", 10)
    for number in range(2, 11):
        add_publisher(proxies, number)
        proxies.apply_event("gone", [number])
    with pytest.raises(ProtocolError, match=r"more than 10 .* one after the other"):
        add_publisher(proxies, 11)


def test_a_node_that_another_one_of_its_name_replaces_has_gone_before_it() -> None:
    """As in tests, each of which makes and destroys a node: nobody is warned of two nodes of one name."""
    here, warnings = Graph(), list[str]()
    there = Graph(log_sink=lambda record: warnings.append(record.text))
    diff = GraphDiff(here, ProxyNodes(here, NobodyListens()), shares_interfaces=False)
    proxies = ProxyNodes(there, NobodyListens())

    def tell() -> None:
        for name, *fields in diff.take_changes():
            proxies.apply_event(name, fields)

    node = create_graph_node(here, "tester")
    tell()
    node.destroy_node()
    other = create_graph_node(here, "tester")
    tell()
    assert not warnings
    assert [each.get_name() for each in there.nodes] == ["tester"]
    other.destroy_node()
    tell()
    assert there.nodes == ()


def test_a_definition_of_too_many_or_too_long_lines_is_refused() -> None:
    graph = Graph(log_sink=lambda record: None)
    proxies = ProxyNodes(graph, NobodyListens(), shares_interfaces=True)
    lines = [f"int8 a{number}" for number in range(proxy_nodes.MAX_LINES)]
    proxies.apply_event("interface", ["own_msgs/msg/Long", lines])
    with pytest.raises(ProtocolError, match=f"an interface of more than {proxy_nodes.MAX_LINES} lines"):
        proxies.apply_event("interface", ["own_msgs/msg/Long", [*lines, "int8 b"]])
    comment = "#" * proxy_nodes.MAX_LINE
    proxies.apply_event("interface", ["own_msgs/msg/Wide", ["int8 a", comment]])
    with pytest.raises(ProtocolError, match=f"at most {proxy_nodes.MAX_LINE} characters"):
        proxies.apply_event("interface", ["own_msgs/msg/Wide", ["int8 a", comment + "#"]])
    name = f"own_msgs/msg/{'N' * MAX_NAME}"[:MAX_NAME]
    proxies.apply_event("interface", [name, ["int8 a"]])
    with pytest.raises(ProtocolError, match=f"at most {MAX_NAME} characters"):
        proxies.apply_event("interface", [f"{name}N", ["int8 a"]])
