"""Who is there: nodes, topics with their publishers and subscriptions, services with their servers and clients."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from kit.msg.message import type_name
from kit.ros.node.qos import QoSPolicyKind, first_incompatibility

if TYPE_CHECKING:
    from kit.ros.graph.graph import Graph
    from kit.ros.graph.node_handle import NodeHandle
    from kit.ros.node.client import Client
    from kit.ros.node.publisher import Publisher
    from kit.ros.node.service import Service
    from kit.ros.node.subscription import Subscription


class Topic:
    """A topic's publishers and subscriptions, and which of them go together."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.publishers: list[Publisher[Any]] = []
        self.subscriptions: list[Subscription[Any]] = []

    @property
    def type_names(self) -> list[str]:
        """The message types in use; more than one is a mistake of somebody's."""
        types = [end.msg_type for end in self.publishers] + [end.msg_type for end in self.subscriptions]
        return sorted({type_name(msg_type) for msg_type in types})

    def add_publisher(self, publisher: Publisher[Any]) -> None:
        self.publishers.append(publisher)
        self._route(publisher)
        for subscription in self.subscriptions:
            _report_mismatch(publisher, subscription)

    def add_subscription(self, subscription: Subscription[Any]) -> None:
        self.subscriptions.append(subscription)
        for publisher in self.publishers:
            self._route(publisher)
            if subscription in publisher.routes:
                publisher.send_history_to(subscription)
            _report_mismatch(publisher, subscription)

    def remove(self, end: Publisher[Any] | Subscription[Any]) -> None:
        self.publishers = [other for other in self.publishers if other is not end]
        self.subscriptions = [other for other in self.subscriptions if other is not end]
        for publisher in self.publishers:
            self._route(publisher)

    def _route(self, publisher: Publisher[Any]) -> None:
        publisher.routes = tuple(sub for sub in self.subscriptions if _mismatch(publisher, sub) is None)


def _mismatch(publisher: Publisher[Any], subscription: Subscription[Any]) -> QoSPolicyKind | str | None:
    """Why the two do not talk: the policy, or in words; None if they do."""
    if publisher.msg_type is not subscription.msg_type:
        return (
            f"{publisher.handle.full_name} publishes {type_name(publisher.msg_type)}, "
            f"{subscription.handle.full_name} subscribes {type_name(subscription.msg_type)}"
        )
    return first_incompatibility(publisher.qos_profile, subscription.qos_profile)


def describe_mismatch(publisher: Publisher[Any], subscription: Subscription[Any]) -> str | None:
    """Why the two do not talk, with the policy's name first: "RELIABILITY: /a offers ..., /b asks for ..."; None
    if they do."""
    mismatch = _mismatch(publisher, subscription)
    if mismatch is None or isinstance(mismatch, str):
        return mismatch
    offered, asked = (_setting(end, mismatch) for end in (publisher, subscription))
    return (
        f"{mismatch.name}: {publisher.handle.full_name} offers {offered}, "
        f"{subscription.handle.full_name} asks for {asked}"
    )


def _report_mismatch(publisher: Publisher[Any], subscription: Subscription[Any]) -> None:
    """Tells both sides, as ROS 2 does: its words first, then what they mean."""
    mismatch = _mismatch(publisher, subscription)
    if mismatch is None:
        return
    topic = publisher.topic_name
    if isinstance(mismatch, str):
        warning = f"topic '{topic}' has two types, nothing will be received: {mismatch}"
        for handle in (publisher.handle, subscription.handle):
            handle.logger.warning(warning)
        return
    offered, asked = (_setting(end, mismatch) for end in (publisher, subscription))
    why = (
        f" (the publisher of {publisher.handle.full_name} offers {offered}, "
        f"the subscription of {subscription.handle.full_name} asks for {asked})"
    )
    publisher.incompatibility_reporter.report(
        mismatch,
        f"New subscription discovered on topic '{topic}', requesting incompatible QoS. "
        f"No messages will be sent to it. Last incompatible policy: {mismatch.name}{why}",
    )
    subscription.incompatibility_reporter.report(
        mismatch,
        f"New publisher discovered on topic '{topic}', offering incompatible QoS. "
        f"No messages will be received from it. Last incompatible policy: {mismatch.name}{why}",
    )


def _setting(end: Publisher[Any] | Subscription[Any], policy: QoSPolicyKind) -> str:
    """What an end's profile says on a policy."""
    setting = getattr(end.qos_profile, policy.name.lower())
    return str(getattr(setting, "name", setting))


class Directory:
    """The register of a graph. Change it with the graph's lock held."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self.version = 0
        """Changes with every node and endpoint that comes or goes."""
        self.nodes: tuple[NodeHandle, ...] = ()
        self.topics: dict[str, Topic] = {}
        self.services: dict[str, list[Service[Any, Any]]] = {}
        self.clients: dict[str, list[Client[Any, Any]]] = {}

    def add_node(self, handle: NodeHandle) -> None:
        if any(other.full_name == handle.full_name for other in self.nodes):
            self._graph.log.warning(
                "rcl",
                f"there is already a node called {handle.full_name}; two of one name get in each other's way",
            )
        self.nodes = (*self.nodes, handle)
        self.version += 1

    def remove_node(self, handle: NodeHandle) -> None:
        self.nodes = tuple(other for other in self.nodes if other is not handle)
        self.version += 1

    def find_node(self, name: str, namespace: str) -> NodeHandle | None:
        """The first node of this name."""
        for handle in self.nodes:
            if handle.name == name and handle.namespace == namespace:
                return handle
        return None

    def get_or_create_topic(self, name: str) -> Topic:
        """The topic of this absolute name, made if need be, for an endpoint to be added to it."""
        self.version += 1
        return self.topics.setdefault(name, Topic(name))

    def remove_endpoint(self, end: Publisher[Any] | Subscription[Any]) -> None:
        self.version += 1
        topic = self.topics[end.topic_name]
        topic.remove(end)
        if not topic.publishers and not topic.subscriptions:
            del self.topics[end.topic_name]

    def add_service(self, service: Service[Any, Any]) -> None:
        self.version += 1
        self.services.setdefault(service.service_name, []).append(service)
        self._graph.notify()

    def remove_service(self, service: Service[Any, Any]) -> None:
        self.version += 1
        _remove_from(self.services, service.service_name, service)

    def add_client(self, client: Client[Any, Any]) -> None:
        self.version += 1
        self.clients.setdefault(client.service_name, []).append(client)

    def remove_client(self, client: Client[Any, Any]) -> None:
        self.version += 1
        _remove_from(self.clients, client.service_name, client)

    def find_server(self, name: str, srv_type: type[Any]) -> Service[Any, Any] | None:
        """The service that answers: the first of this name and type."""
        for service in self.services.get(name, ()):
            if service.srv_type is srv_type:
                return service
        return None

    def topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Sorted by name."""
        return [(name, topic.type_names) for name, topic in sorted(self.topics.items())]

    def service_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Of the services that somebody serves, sorted by name."""
        return [
            (name, sorted({type_name(service.srv_type) for service in servers}))
            for name, servers in sorted(self.services.items())
        ]

    def publishers(self, topic: str) -> Iterator[Publisher[Any]]:
        found = self.topics.get(topic)
        yield from found.publishers if found is not None else ()

    def subscriptions(self, topic: str) -> Iterator[Subscription[Any]]:
        found = self.topics.get(topic)
        yield from found.subscriptions if found is not None else ()


def _remove_from(register: dict[str, list[Any]], name: str, end: object) -> None:
    rest = [other for other in register[name] if other is not end]
    if rest:
        register[name] = rest
    else:
        del register[name]
