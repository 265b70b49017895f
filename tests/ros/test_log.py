"""Log lines."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.rcl_interfaces import Log
from kit.ros.execution.client_library import (
    get_logger,
    get_logger_effective_level,
    get_logger_level,
    set_logger_level,
)
from kit.ros.execution.context import context_of, default_context
from kit.ros.graph.graph import Graph
from kit.ros.log import LoggingSeverity, LogRecord, get_logging_severity_from_string, log_to_stderr
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import QoSProfile


@pytest.fixture
def node(graph: Graph) -> Node:
    return create_graph_node(graph, "node", "/ns")


def test_a_line_looks_as_in_ros(graph: Graph, node: Node, lines: list[LogRecord]) -> None:
    graph.advance(12_000_000_034)
    assert node.get_logger().info("hello")
    assert str(lines[0]) == "[INFO] [12.000000034] [ns.node]: hello"
    assert lines[0].function == "test_a_line_looks_as_in_ros"
    assert lines[0].file == __file__


def test_without_a_sink_it_goes_to_the_error_stream(capsys: pytest.CaptureFixture[str]) -> None:
    create_graph_node(Graph(), "n").get_logger().error("broken")
    assert capsys.readouterr().err == "[ERROR] [0.000000000] [n]: broken\n"


def test_each_level_has_its_method(node: Node, lines: list[LogRecord]) -> None:
    logger = node.get_logger()
    logger.set_level(LoggingSeverity.DEBUG)
    for method in (logger.debug, logger.info, logger.warn, logger.warning, logger.error, logger.fatal):
        method("x")
    logger.log("x", LoggingSeverity.WARN)
    assert [line.severity.name for line in lines] == [
        "DEBUG",
        "INFO",
        "WARN",
        "WARN",
        "ERROR",
        "FATAL",
        "WARN",
    ]


def test_lines_below_the_level_are_dropped(node: Node, lines: list[LogRecord]) -> None:
    logger = node.get_logger()
    assert not logger.debug("x")
    logger.set_level(LoggingSeverity.ERROR)
    assert not logger.warning("x")
    assert not logger.is_enabled_for(LoggingSeverity.WARN)
    child = logger.get_child("arm")
    assert child.name == "ns.node.arm"
    assert child.get_effective_level() is LoggingSeverity.ERROR
    child.set_level(LoggingSeverity.DEBUG)
    assert child.debug("y")
    child.set_level(LoggingSeverity.UNSET)
    assert not child.info("z")
    assert [line.text for line in lines] == ["y"]
    with pytest.raises(ValueError, match="empty"):
        logger.get_child("")


class TestFilters:
    """They count per line of code that calls."""

    def test_once_and_skip_first(self, node: Node, lines: list[LogRecord]) -> None:
        for number in range(3):
            node.get_logger().info(f"once {number}", once=True)
            node.get_logger().info(f"skip {number}", skip_first=True)
        assert [line.text for line in lines] == ["once 0", "skip 1", "skip 2"]

    def test_throttle_in_the_graphs_time(self, graph: Graph, node: Node, lines: list[LogRecord]) -> None:
        for tick in range(25):
            graph.advance(tick * 100_000_000)
            node.get_logger().info(str(tick), throttle_duration_sec=1.0)
        graph.advance(0)
        node.get_logger().info("another line", throttle_duration_sec=1.0)
        assert [line.text for line in lines] == ["0", "10", "20", "another line"]

    def test_throttle_survives_a_reset_of_time(
        self, graph: Graph, node: Node, lines: list[LogRecord]
    ) -> None:
        for moment in (50, 50, 0, 0):
            graph.advance(moment * 1_000_000_000)
            node.get_logger().info(str(moment), throttle_duration_sec=10)
        assert [line.text for line in lines] == ["50", "0"]

    def test_an_unknown_filter_is_an_error(self, node: Node) -> None:
        with pytest.raises(TypeError):
            node.get_logger().info("x", onec=True)


def test_lines_are_published_on_rosout_also_earlier_ones(graph: Graph, node: Node) -> None:
    node.get_logger().warn("early")
    heard: list[Log] = []
    from kit.ros.node.qos import DurabilityPolicy

    latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    create_graph_node(graph, "listener").create_subscription(Log, "/rosout", heard.append, latched)
    node.get_logger().error("late")
    graph.run_due()
    assert [(message.name, message.level, message.msg) for message in heard] == [
        ("ns.node", Log.WARN, "early"),
        ("ns.node", Log.ERROR, "late"),
    ]


def test_rosout_can_be_left_out(graph: Graph) -> None:
    Node("quiet", context=context_of(graph), enable_rosout=False).get_logger().info("x")
    assert "/rosout" not in graph.directory.topics


def test_loggers_without_a_node(graph: Graph, lines: list[LogRecord]) -> None:
    with default_context(context_of(graph)):
        get_logger("tools").info("x")
        assert get_logger_level("tools") is LoggingSeverity.UNSET
        set_logger_level("tools", LoggingSeverity.WARN)
        assert get_logger_level("tools") is get_logger_effective_level("tools.hammer") is LoggingSeverity.WARN
        assert not get_logger("tools.hammer").info("y")
        with pytest.raises(ValueError, match="empty"):
            get_logger("")
    assert [line.name for line in lines] == ["tools"]


@pytest.mark.parametrize(("text", "level"), [("debug", 10), ("INFO", 20), ("Fatal", 50)])
def test_levels_by_name(text: str, level: int) -> None:
    assert get_logging_severity_from_string(text) == level
    with pytest.raises(RuntimeError, match="debug"):
        get_logging_severity_from_string("loud")


def test_anything_can_be_logged(node: Node, lines: list[LogRecord]) -> None:
    message: Any = ["a", 1]
    node.get_logger().info(message)
    assert lines[0].text == "['a', 1]"


def test_lines_take_another_form_or_stream(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    record = LogRecord(1_500_000_000, LoggingSeverity.WARN, "ns.node", "a {name}", "drive.py", "turn", 7)
    log_to_stderr(record)
    template = (
        "{severity} {time} {name}: {message} ({function_name}() at {file_name}:{line_number}) {nothing}"
    )
    monkeypatch.setenv("RCUTILS_CONSOLE_OUTPUT_FORMAT", template)
    log_to_stderr(record)
    monkeypatch.setenv("RCUTILS_LOGGING_USE_STDOUT", "1")
    monkeypatch.setenv("RCUTILS_CONSOLE_OUTPUT_FORMAT", "{time_as_nanoseconds}\\t{message}")
    log_to_stderr(record)
    printed = capsys.readouterr()
    assert printed.err == (
        "[WARN] [1.500000000] [ns.node]: a {name}\n"
        "WARN 1.500000000 ns.node: a {name} (turn() at drive.py:7) {nothing}\n"
    )
    assert printed.out == "1500000000\ta {name}\n"
