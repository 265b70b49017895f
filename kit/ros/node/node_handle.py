"""The internal record of a node, kept apart from the node itself.

So a student's node class may use any attribute names except rclpy's own.
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
    from kit.ros.graph.directory import GraphNode
    from kit.ros.graph.graph import Graph
    from kit.ros.log import RcutilsLogger
    from kit.ros.node.client import Client
    from kit.ros.node.endpoint import Destroyable, Entity, GuardCondition
    from kit.ros.node.publisher import Publisher
    from kit.ros.node.service import Service
    from kit.ros.node.subscription import Subscription
    from kit.ros.node.timer import Rate, Timer
    from kit.ros.node.waitable import WaitableItem
    from kit.ros.parameters.parameter_store import ParameterStore


class NodeHandle:
    """A node's names, what it has made, and the ready queue its callbacks wait in."""

    parameters: ParameterStore
    logger: RcutilsLogger

    def __init__(
        self, node: GraphNode, context: Context, arguments: RosArguments, name: str, namespace: str
    ) -> None:
        self.node = node
        self.context = context
        self.graph: Graph = context.graph
        self.arguments = arguments
        self.name = name
        self.namespace = namespace
        self.ready_queue: ReadyQueue = self.graph.ready_queue
        """The queue of its executor, or the graph's own for lock-step."""
        self.destroyed = False
        self.publishers: list[Publisher[Any]] = []
        self.subscriptions: list[Subscription[Any]] = []
        self.clients: list[Client[Any, Any]] = []
        self.services: list[Service[Any, Any]] = []
        self.timers: list[Timer] = []
        self.guards: list[GuardCondition] = []
        self.rates: list[Rate] = []
        self.waitables: list[WaitableItem] = []
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
        """Moves the node and its waiting callbacks to the queue of another executor; None: of the lock-step."""
        ready_queue = self.graph.ready_queue if executor is None else executor.ready_queue
        with self.graph.lock:
            before, self.ready_queue = self.ready_queue, ready_queue
            self._executor = None if executor is None else weakref.ref(executor)
            ready_queue.take_over_node(self, before)

    @property
    def is_spun(self) -> bool:
        """True if a thread is spinning it."""
        executor = self.executor
        return executor is not None and executor.is_spinning

    def all_entities(self) -> list[Destroyable]:
        """Everything that the node has made, in no particular order."""
        return [
            *self.publishers,
            *self.subscriptions,
            *self.clients,
            *self.services,
            *self.timers,
            *self.guards,
            *self.rates,
        ]

    def remove_entity(self, entity: Destroyable) -> None:
        """Removes something destroyed from the node's lists."""
        lists: tuple[list[Any], ...] = (
            self.publishers,
            self.subscriptions,
            self.clients,
            self.services,
            self.timers,
            self.guards,
            self.rates,
        )
        for entities in lists:
            if entity in entities:
                entities.remove(entity)

    def rewind(self) -> None:
        """Restarts timers and rates after a jump back in time. With the graph's lock held."""
        for timer in self.timers:
            timer.rewind()
        for rate in self.rates:
            rate.rewind()
        for events in [entity.events for entity in self.publishers] + [
            entity.events for entity in self.subscriptions
        ]:
            if events.deadline is not None:
                events.deadline.rewind()

    def discard_queues(self) -> None:
        """Drops all queued messages, requests and responses. With the graph's lock held."""
        entities: list[Entity] = [*self.subscriptions, *self.clients, *self.services]
        for entity in entities:
            entity.discard_queue()
