"""Waitables of a program's own: an executor waits for them and executes them in their callback groups."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from kit.ros.execution.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.waitable import NumberOfEntities, Waitable, WaitableGuardCondition, WaitSet


class Inbox(Waitable[list[int]]):
    """Numbers that any thread puts in, and that are executed together."""

    def __init__(self, node: Node, group: CallbackGroup | None = None) -> None:
        super().__init__(group or ReentrantCallbackGroup())
        self._guard = WaitableGuardCondition(None, None, context=node.context)
        self._index = 0
        self._is_ready = False
        self.numbers: list[int] = []
        self.executed: list[list[int]] = []
        self.waits_for: Future[None] | None = None

    def put(self, number: int) -> None:
        self.numbers.append(number)
        self._guard.trigger()

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        with self._guard.handle:
            self._index = wait_set.add_guard_condition(self._guard.handle)

    def is_ready(self, wait_set: WaitSet) -> bool:
        self._is_ready |= wait_set.is_ready("guard_condition", self._index)
        return self._is_ready

    def take_data(self) -> list[int]:
        self._is_ready = False
        taken, self.numbers = self.numbers, []
        return taken

    async def execute(self, taken_data: list[int]) -> None:
        if self.waits_for is not None:
            await self.waits_for
        self.executed.append(taken_data)

    def get_num_entities(self) -> NumberOfEntities:
        return NumberOfEntities(num_gcs=1)


@pytest.fixture
def node(graph: Graph) -> Iterator[Node]:
    made = create_graph_node(graph, "waiting")
    yield made
    made.destroy_node()


def test_the_lock_step_executes_it(graph: Graph, node: Node) -> None:
    inbox = Inbox(node)
    inbox.put(1)
    node.add_waitable(inbox)
    assert list(node.waitables) == [inbox]
    graph.run_due()
    assert inbox.executed == [[1]]
    inbox.put(2)
    inbox.put(3)
    graph.run_due()
    graph.run_due()
    assert inbox.executed == [[1], [2, 3]]


def test_it_is_forgotten_when_it_is_removed(graph: Graph, node: Node) -> None:
    inbox = Inbox(node)
    node.add_waitable(inbox)
    node.remove_waitable(inbox)
    inbox.put(1)
    graph.run_due()
    assert inbox.executed == list(node.waitables) == []
    with pytest.raises(ValueError, match="/waiting"):
        node.remove_waitable(inbox)
    node.add_waitable(inbox)
    node.destroy_node()
    graph.run_due()
    assert inbox.executed == []


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_a_thread_that_spins_is_woken(kind: type[Executor]) -> None:
    graph = Graph(None)
    node = create_graph_node(graph, "waiting")
    inbox = Inbox(node)
    node.add_waitable(inbox)
    with kind(context=context_of(graph)) as executor:
        executor.add_node(node)
        threading.Timer(0.02, inbox.put, (7,)).start()
        while not inbox.executed:
            executor.spin_once(timeout_sec=10.0)
    assert inbox.executed == [[7]]


def test_its_callback_group_is_heeded(graph: Graph, node: Node) -> None:
    group = MutuallyExclusiveCallbackGroup()
    inbox, other = Inbox(node, group), Inbox(node, group)
    inbox.waits_for = Future()
    node.add_waitable(inbox)
    node.add_waitable(other)
    inbox.put(1)
    other.put(2)
    graph.run_due()
    assert inbox.executed == other.executed == []
    inbox.waits_for.set_result(None)
    graph.run_due()
    assert (inbox.executed, other.executed) == ([[1]], [[2]])


def test_only_guard_conditions_can_be_waited_for(graph: Graph, node: Node) -> None:
    class Reader(Inbox):
        def add_to_wait_set(self, wait_set: Any) -> None:
            wait_set.add_subscription(object())

    node.add_waitable(Reader(node))
    with pytest.raises(NotImplementedError, match="guard conditions"):
        graph.run_due()


def test_numbers_of_entities_are_added() -> None:
    both = NumberOfEntities(1, 2, 3, 4, 5) + NumberOfEntities(10, 20, 30, 40, 50, 60)
    assert repr(both) == "<NumberOfEntities(11, 22, 33, 44, 55, 60)>"
    both += NumberOfEntities(num_gcs=1)
    assert both.num_guard_conditions == 23
