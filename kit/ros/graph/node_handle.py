"""What the library knows of a node, kept apart from the node itself.

A student's node class may call its attributes what it likes; only rclpy's own names are taken.
"""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from kit.ros.graph.naming import full_name
from kit.ros.graph.ready_queue import ReadyQueue

if TYPE_CHECKING:
    from kit.ros.execution.arguments import RosArguments
    from kit.ros.execution.context import Context
    from kit.ros.execution.executors import Executor
    from kit.ros.graph.graph import Graph
    from kit.ros.log import RcutilsLogger
    from kit.ros.node.client import Client
    from kit.ros.node.endpoint import Destroyable, Entity
    from kit.ros.node.guard_condition import GuardCondition
    from kit.ros.node.node import Node
    from kit.ros.node.publisher import Publisher
    from kit.ros.node.service import Service
    from kit.ros.node.subscription import Subscription
    from kit.ros.node.timer import Rate, Timer
    from kit.ros.parameters.parameter_store import ParameterStore


class NodeHandle:
    """A node's place in its graph: its names, what it has made, and whose ready_queue it is on."""

    parameters: ParameterStore
    logger: RcutilsLogger

    def __init__(
        self, node: Node, context: Context, arguments: RosArguments, name: str, namespace: str
    ) -> None:
        self.node = node
        self.context = context
        self.graph: Graph = context.graph
        self.arguments = arguments
        self.name = name
        self.namespace = namespace
        self.ready_queue: ReadyQueue = self.graph.ready_queue
        """Where its callbacks wait: its executor's, or lock-step's."""
        self.destroyed = False
        self.publishers: list[Publisher[Any]] = []
        self.subscriptions: list[Subscription[Any]] = []
        self.clients: list[Client[Any, Any]] = []
        self.services: list[Service[Any, Any]] = []
        self.timers: list[Timer] = []
        self.guards: list[GuardCondition] = []
        self.rates: list[Rate] = []
        self._executor: weakref.ref[Executor] | None = None

    @property
    def full_name(self) -> str:
        return full_name(self.name, self.namespace)

    @property
    def logger_name(self) -> str:
        return self.full_name[1:].replace("/", ".")

    @property
    def executor(self) -> Executor | None:
        return self._executor() if self._executor is not None else None

    def set_executor(self, executor: Executor | None) -> None:
        """Moves the node, with everything that waits for it, to another executor's ready_queue, or to lock-step's."""
        ready_queue = self.graph.ready_queue if executor is None else executor.ready_queue
        with self.graph.lock:
            before, self.ready_queue = self.ready_queue, ready_queue
            self._executor = None if executor is None else weakref.ref(executor)
            ready_queue.take_over_node(self, before)

    @property
    def is_spun(self) -> bool:
        """Whether some thread is spinning it."""
        executor = self.executor
        return executor is not None and executor.is_spinning

    def all_entities(self) -> list[Destroyable]:
        """All that the node has made, in no particular order."""
        return [
            *self.publishers,
            *self.subscriptions,
            *self.clients,
            *self.services,
            *self.timers,
            *self.guards,
            *self.rates,
        ]

    def remove_entity(self, made: Destroyable) -> None:
        """Takes something out of the node's lists."""
        lists: tuple[list[Any], ...] = (
            self.publishers,
            self.subscriptions,
            self.clients,
            self.services,
            self.timers,
            self.guards,
            self.rates,
        )
        for kept in lists:
            if made in kept:
                kept.remove(made)

    def rewind(self) -> None:
        """Time has jumped back. With the graph's lock held."""
        for timer in self.timers:
            timer.rewind()
        for rate in self.rates:
            rate.rewind()

    def discard_queues(self) -> None:
        """Forgets all messages, requests and responses that wait for it. With the graph's lock held."""
        entities: list[Entity] = [*self.subscriptions, *self.clients, *self.services]
        for entity in entities:
            entity.discard_queue()
