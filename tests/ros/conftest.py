"""Shared by the tests of the conversation: a simulated graph, and ROS 2's import names for those who ask."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import pytest

from kit.ros import names_folder
from kit.ros.execution.context import set_default_graph
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord


@pytest.fixture
def lines() -> list[LogRecord]:
    """What the graph has logged."""
    return []


@pytest.fixture
def graph(lines: list[LogRecord]) -> Graph:
    """A simulated graph at time 0."""
    return Graph(log_sink=lines.append)


@pytest.fixture
def alone(lines: list[LogRecord]) -> Iterator[Graph]:
    """The default graph of a program that stands alone: on the system's time."""
    graph = Graph(None, log_sink=lines.append)
    set_default_graph(graph)
    yield graph
    set_default_graph(None)


@pytest.fixture
def import_names(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """``import rclpy`` and the like work in this test."""
    folder = names_folder()
    monkeypatch.syspath_prepend(folder)
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if (getattr(sys.modules[name], "__file__", None) or "").startswith(folder):
            del sys.modules[name]
