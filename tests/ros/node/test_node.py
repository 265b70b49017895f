"""Services for log levels, by which tools make a running node talk more or less."""

from __future__ import annotations

from typing import Any

from kit.msg.interfaces import find_message, find_service
from kit.ros.execution.context import context_of
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.node import Node, create_graph_node


def call(graph: Graph, service: str, **fields: Any) -> Any:
    definition: Any = find_service(f"rcl_interfaces/srv/{service}")
    name = {"GetLoggerLevels": "get_logger_levels", "SetLoggerLevels": "set_logger_levels"}[service]
    client = create_graph_node(graph, "asking").create_client(definition, f"/node/{name}")
    future = client.call_async(definition.Request(**fields))
    graph.run_due()
    return future.result()


def test_levels_can_be_set_and_read(graph: Graph, lines: list[LogRecord]) -> None:
    node = Node("node", context=context_of(graph), enable_logger_service=True)
    make: Any = lambda name, level: find_message("rcl_interfaces/msg/LoggerLevel")(name=name, level=level)  # noqa: E731 - a function would say its types twice
    read = call(graph, "GetLoggerLevels", names=["node"])
    assert [(entry.name, entry.level) for entry in read.levels] == [("node", 0)]
    done = call(graph, "SetLoggerLevels", levels=[make("node", 40), make("other", 7)])
    assert [result.successful for result in done.results] == [True, False]
    assert "7" in done.results[1].reason
    node.get_logger().warning("not to be seen")
    node.get_logger().error("to be seen")
    assert [line.text for line in lines if line.name == "node"] == ["to be seen"]


def test_without_the_option_there_are_none(graph: Graph) -> None:
    Node("node", context=context_of(graph))
    assert not [name for name, _ in graph.directory.service_names_and_types() if "logger" in name]
