"""Executors and callback groups that a program defines itself."""

from __future__ import annotations

from typing import Any

import pytest

from kit.msg.std_msgs import String
from kit.ros.execution.callback_groups import CallbackGroup
from kit.ros.execution.executors import (
    ConditionReachedException,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
)
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node


class Tokens(CallbackGroup):
    """Admits as many callbacks as it has tokens."""

    def __init__(self) -> None:
        super().__init__()
        self.tokens = 2

    def beginning_execution(self, entity: Any) -> bool:
        self.tokens -= 1
        return self.tokens >= 0

    def ending_execution(self, entity: Any) -> None:
        pass


def test_a_group_of_the_programs_own_is_asked_again(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    group = Tokens()
    heard: list[str] = []
    node.create_subscription(
        String, "s", lambda message: heard.append(message.data), 10, callback_group=group
    )
    publisher = node.create_publisher(String, "s", 10)
    for word in "abc":
        publisher.publish(String(data=word))
    graph.run_due()
    assert heard == ["a", "b"]

    def refill() -> None:
        group.tokens = 1

    node.create_timer(0.1, refill)
    graph.advance(100_000_000)
    graph.run_due()
    assert heard == ["a", "b", "c"]


def test_an_executor_of_the_programs_own(graph: Graph) -> None:
    """It takes its work from wait_for_ready_callbacks, and decides where it is done."""
    node = create_graph_node(graph, "node")
    taken: list[tuple[str, Any]] = []

    class OwnExecutor(SingleThreadedExecutor):
        def spin_once(self, timeout_sec: float | None = None) -> None:
            task, entity, owner = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
            taken.append((str(entity), owner))
            task()
            if len(taken) == 2:
                self.shutdown()

    executor = OwnExecutor(context=node.context)
    executor.add_node(node)
    heard: list[str] = []
    node.create_subscription(String, "s", lambda message: heard.append(message.data), 10)
    publisher = node.create_publisher(String, "s", 10)
    for word in "ab":
        publisher.publish(String(data=word))
    executor.spin()
    assert heard == ["a", "b"]
    assert [owner for _, owner in taken] == [node, node]


def test_waiting_for_callbacks_that_do_not_come(graph: Graph) -> None:
    node = create_graph_node(graph, "node")
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    with pytest.raises(TimeoutException):
        executor.wait_for_ready_callbacks(timeout_sec=0)
    with pytest.raises(ConditionReachedException):
        executor.wait_for_ready_callbacks(condition=lambda: True)
    executor.shutdown()
    with pytest.raises(ShutdownException):
        executor.wait_for_ready_callbacks()
