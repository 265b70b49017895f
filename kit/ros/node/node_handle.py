"""The internal record of a node, kept apart from the node itself.

So a student's node class may use any attribute names except rclpy's own.

The methods of a node that list the nodes, topics and services of the graph.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from kit.msg.message import type_name
from kit.ros.exceptions import NodeNameNonExistentError
from kit.ros.graph.action_names import NamesAndTypes, action_names_and_types, called_actions, served_actions
from kit.ros.graph.directory import NodeEntry, NodeLike
from kit.ros.graph.naming import expand_topic_name, full_name, validate_topic_name
from kit.ros.graph.ready_queue import ReadyQueue
from kit.ros.node.endpoint import (
    CallbackEntity,
    Destroyable,
    GuardCondition,
    TopicEndpointInfo,
    TopicEndpointTypeEnum,
)
from kit.ros.node.time import S_TO_NS

if TYPE_CHECKING:
    from kit.ros.execution.arguments import RosArguments
    from kit.ros.execution.context import Context
    from kit.ros.execution.executors import Executor
    from kit.ros.graph.graph import Graph
    from kit.ros.log import RcutilsLogger
    from kit.ros.node.client import Client
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
        self, node: NodeLike, context: Context, arguments: RosArguments, name: str, namespace: str
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
            for watch in events.watches:
                watch.rewind()

    def discard_queues(self) -> None:
        """Drops all queued messages, requests and responses. With the graph's lock held."""
        entities: list[CallbackEntity] = [*self.subscriptions, *self.clients, *self.services]
        for entity in entities:
            entity.discard_queue()


class NodeGraphMethods:
    """A part of Node. Names are absolute; lists are sorted by name."""

    if TYPE_CHECKING:

        @property
        def handle(self) -> NodeHandle: ...

    def get_node_names(self) -> list[str]:
        """Returns the nodes' names without their namespaces, in the order of creation."""
        return [handle.name for handle in self.handle.graph.directory.nodes]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [(handle.name, handle.namespace) for handle in self.handle.graph.directory.nodes]

    def get_fully_qualified_node_names(self) -> list[str]:
        return [handle.full_name for handle in self.handle.graph.directory.nodes]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """The third of each is its enclave, of which there is one here."""
        return [(name, namespace, "/") for name, namespace in self.get_node_names_and_namespaces()]

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Waits until a node has this name; False after ``timeout`` seconds of the graph's time."""
        name = f"/{fully_qualified_node_name.lstrip('/')}"
        graph = self.handle.graph
        return graph.wait(
            lambda: any(handle.full_name == name for handle in graph.directory.nodes),
            graph.now_ns + int(timeout * S_TO_NS),
            what="wait_for_node()",
        )

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        return self.handle.graph.directory.topic_names_and_types()

    def get_service_names_and_types(self) -> NamesAndTypes:
        return self.handle.graph.directory.service_names_and_types()

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Raises NodeNameNonExistentError."""
        endpoints = _find_node(self.handle, node_name, node_namespace).publishers
        return _names_and_types((endpoint.topic_name, endpoint.msg_type) for endpoint in endpoints)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Raises NodeNameNonExistentError."""
        endpoints = _find_node(self.handle, node_name, node_namespace).subscriptions
        return _names_and_types((endpoint.topic_name, endpoint.msg_type) for endpoint in endpoints)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Raises NodeNameNonExistentError."""
        endpoints = _find_node(self.handle, node_name, node_namespace).services
        return _names_and_types((endpoint.service_name, endpoint.srv_type) for endpoint in endpoints)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Raises NodeNameNonExistentError."""
        endpoints = _find_node(self.handle, node_name, node_namespace).clients
        return _names_and_types((endpoint.service_name, endpoint.srv_type) for endpoint in endpoints)

    def get_action_names_and_types(self) -> NamesAndTypes:
        return action_names_and_types(self.handle.graph.directory)

    def get_action_server_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Raises NodeNameNonExistentError."""
        return served_actions(_find_node(self.handle, node_name, node_namespace))

    def get_action_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Raises NodeNameNonExistentError."""
        return called_actions(_find_node(self.handle, node_name, node_namespace))

    # As in rclpy, these four ask for a name as it is: remappings of the node's own do not apply to it.

    def count_publishers(self, topic_name: str) -> int:
        name = self.resolve_topic_name(topic_name, only_expand=True)
        self.handle.graph.count_read()
        return sum(1 for _ in self.handle.graph.directory.publishers(name))

    def count_subscribers(self, topic_name: str) -> int:
        name = self.resolve_topic_name(topic_name, only_expand=True)
        self.handle.graph.count_read()
        return sum(1 for _ in self.handle.graph.directory.subscriptions(name))

    def count_clients(self, service_name: str) -> int:
        name = self.resolve_service_name(service_name, only_expand=True)
        return len(self.handle.graph.directory.clients.get(name, ()))

    def count_services(self, service_name: str) -> int:
        name = self.resolve_service_name(service_name, only_expand=True)
        return len(self.handle.graph.directory.services.get(name, ()))

    def get_publishers_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        endpoints = self.handle.graph.directory.publishers(self.resolve_topic_name(topic_name))
        return [TopicEndpointInfo.of(endpoint, TopicEndpointTypeEnum.PUBLISHER) for endpoint in endpoints]

    def get_subscriptions_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        endpoints = self.handle.graph.directory.subscriptions(self.resolve_topic_name(topic_name))
        return [TopicEndpointInfo.of(endpoint, TopicEndpointTypeEnum.SUBSCRIPTION) for endpoint in endpoints]

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The absolute name of ``topic`` for this node, remapped unless ``only_expand``.

        Raises InvalidTopicNameException.
        """
        handle = self.handle
        validate_topic_name(topic)
        if only_expand:
            return expand_topic_name(topic, handle.name, handle.namespace)
        return handle.arguments.topic(topic, handle.name, handle.namespace)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Resolves a service name as ``resolve_topic_name`` does. Raises InvalidServiceNameException."""
        handle = self.handle
        validate_topic_name(service, is_service=True)
        if only_expand:
            return expand_topic_name(service, handle.name, handle.namespace)
        return handle.arguments.service(service, handle.name, handle.namespace)


def _find_node(handle: NodeHandle, name: str, namespace: str) -> NodeEntry:
    found = handle.graph.directory.find_node(name, namespace)
    if found is None:
        raise NodeNameNonExistentError(f"there is no node '{name}' in namespace '{namespace}'")
    return found


def _names_and_types(endpoints: Iterable[tuple[str, type[Any]]]) -> NamesAndTypes:
    types: dict[str, set[str]] = {}
    for name, interface in endpoints:
        types.setdefault(name, set()).add(type_name(interface))
    return [(name, sorted(found)) for name, found in sorted(types.items())]
