"""The directory of a graph: its nodes, topics with their endpoints, and services with their servers and clients.

The directory knows nodes and endpoints by the protocols below; the classes themselves are built on the graph.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol, TypeVar

from kit.msg.message import type_name
from kit.ros.node.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
    first_incompatibility,
)
from kit.ros.node.time import Duration

if TYPE_CHECKING:
    from kit.ros.log import LoggerSettings, RcutilsLogger

WORLD_NODE_NAME: Final = "flatland_server"
STAMPED_COMMAND: Final = ("geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist")
"""The types of a publisher and of a subscription of the world's node that do not match and yet drive a robot: the world takes
commands in either form, as bases of older and of newer distributions do, and subscribes to the second when it is published."""


MAX_EXCESSES: Final = 100
"""Excesses that are kept: a program may make nodes without end."""


class Excess(NamedTuple):
    """A command for more than is carried out, and what is, both with their unit."""

    asked: str
    largest: str


class NodeLike(Protocol):
    """The part of a Node that the graph and its listeners use."""

    @property
    def handle(self) -> NodeEntry: ...

    def get_name(self) -> str: ...

    def get_namespace(self) -> str: ...

    def get_fully_qualified_name(self) -> str: ...


class NodeEntry(Protocol):
    """The part of a NodeEntry that the directory needs."""

    @property
    def node(self) -> NodeLike: ...

    @property
    def name(self) -> str: ...

    @property
    def namespace(self) -> str: ...

    @property
    def full_name(self) -> str: ...

    @property
    def logger(self) -> RcutilsLogger: ...

    @property
    def publishers(self) -> Sequence[TopicPublisher]: ...

    @property
    def subscriptions(self) -> Sequence[TopicSubscription]: ...

    @property
    def services(self) -> Sequence[ServiceServer]: ...

    @property
    def clients(self) -> Sequence[ServiceClient]: ...

    def rewind(self) -> None: ...

    def discard_queues(self) -> None: ...


class EndpointEventReporter(Protocol):
    """Tells an endpoint which others match it, and which cannot."""

    def report_incompatible_qos(self, policy: QoSPolicyKind, warning: str) -> None: ...

    def report_incompatible_type(self, warning: str) -> None: ...

    def set_matched_count(self, count: int) -> None: ...

    def set_alive_counts(self, alive: int, not_alive: int) -> None: ...


class GraphEndpoint(Protocol):
    """A publisher or a subscription."""

    @property
    def handle(self) -> NodeEntry: ...

    @property
    def topic_name(self) -> str: ...

    @property
    def msg_type(self) -> type[Any]: ...

    @property
    def qos_profile(self) -> QoSProfile: ...

    @property
    def number(self) -> int: ...

    @property
    def events(self) -> EndpointEventReporter: ...


class TopicSubscription(GraphEndpoint, Protocol):
    def enqueue(self, msg: Any) -> None: ...


class TopicPublisher(GraphEndpoint, Protocol):
    routes: tuple[TopicSubscription, ...]
    is_alive: bool | None
    has_lease: bool

    def send_history_to(self, subscription: TopicSubscription) -> None: ...


class ServiceEndpoint(Protocol):
    """A service's server or a client."""

    @property
    def handle(self) -> NodeEntry: ...

    @property
    def service_name(self) -> str: ...

    @property
    def srv_type(self) -> type[Any]: ...

    @property
    def qos_profile(self) -> QoSProfile: ...

    @property
    def number(self) -> int: ...


class ServiceClient(ServiceEndpoint, Protocol):
    def enqueue(self, number: int, response: Any) -> None: ...

    def report_lost_server(self) -> None: ...


class ServiceServer(ServiceEndpoint, Protocol):
    def enqueue(self, call: Any) -> None: ...


Registered = TypeVar("Registered", bound=ServiceEndpoint)


class Topic:
    """The publishers and subscriptions of a topic, and which publisher reaches which subscription."""

    def __init__(self, name: str, subscribed: set[str]) -> None:
        """``subscribed``: the names of the topics that have subscriptions, which this one keeps up to date."""
        self.name = name
        self.publishers: list[TopicPublisher] = []
        self.subscriptions: list[TopicSubscription] = []
        self.on_other_type: Callable[[type[Any]], None] | None = None
        """Called with the type of a new publisher that no subscription has: whoever takes it may subscribe."""
        self._subscribed = subscribed

    @property
    def type_names(self) -> list[str]:
        """The message types in use, sorted; more than one is a mistake in some node."""
        types = [endpoint.msg_type for endpoint in self.publishers] + [
            endpoint.msg_type for endpoint in self.subscriptions
        ]
        return sorted({type_name(msg_type) for msg_type in types})

    def add_publisher(self, publisher: TopicPublisher) -> None:
        is_taken = any(each.msg_type is publisher.msg_type for each in self.subscriptions)
        if self.on_other_type is not None and not is_taken:
            self.on_other_type(publisher.msg_type)
        self.publishers.append(publisher)
        self._route(publisher)
        self._count_matches()
        for subscription in self.subscriptions:
            _report_mismatch(publisher, subscription)

    def add_subscription(self, subscription: TopicSubscription) -> None:
        self.subscriptions.append(subscription)
        self._subscribed.add(self.name)
        for publisher in self.publishers:
            self._route(publisher)
            if subscription in publisher.routes:
                publisher.send_history_to(subscription)
            _report_mismatch(publisher, subscription)
        self._count_matches()

    def remove(self, endpoint: GraphEndpoint) -> None:
        self.publishers = [other for other in self.publishers if other is not endpoint]
        self.subscriptions = [other for other in self.subscriptions if other is not endpoint]
        if not self.subscriptions:
            self._subscribed.discard(self.name)
        for publisher in self.publishers:
            self._route(publisher)
        self._count_matches()

    def _route(self, publisher: TopicPublisher) -> None:
        publisher.routes = tuple(sub for sub in self.subscriptions if _mismatch(publisher, sub) is None)

    def _count_matches(self) -> None:
        """Tells every endpoint how many others it matches."""
        received = Counter(sub.number for publisher in self.publishers for sub in publisher.routes)
        for publisher in self.publishers:
            publisher.events.set_matched_count(len(publisher.routes))
        for subscription in self.subscriptions:
            subscription.events.set_matched_count(received[subscription.number])
        self.count_alive()

    def count_alive(self) -> None:
        """Tells every subscription how many of its publishers are alive, and how many no longer."""
        states = Counter(
            (sub.number, publisher.is_alive) for publisher in self.publishers for sub in publisher.routes
        )
        for sub in self.subscriptions:
            sub.events.set_alive_counts(states[sub.number, True], states[sub.number, False])


def _mismatch(publisher: TopicPublisher, subscription: TopicSubscription) -> QoSPolicyKind | str | None:
    """The policy on which the two are incompatible, or the difference of their types; None if they match."""
    if publisher.msg_type is not subscription.msg_type:
        return (
            f"{publisher.handle.full_name} publishes {type_name(publisher.msg_type)}, "
            f"{subscription.handle.full_name} subscribes {type_name(subscription.msg_type)}"
        )
    return first_incompatibility(publisher.qos_profile, subscription.qos_profile)


def describe_mismatch(publisher: TopicPublisher, subscription: TopicSubscription) -> str | None:
    """Why no message passes between the two, such as "RELIABILITY: /a offers ..., /b asks for ..."; None if they
    match."""
    mismatch = _mismatch(publisher, subscription)
    if mismatch is None or isinstance(mismatch, str):
        return mismatch
    offered, asked = (_setting(endpoint, mismatch) for endpoint in (publisher, subscription))
    return (
        f"{mismatch.name}: {publisher.handle.full_name} offers {offered}, "
        f"{subscription.handle.full_name} asks for {asked}"
    )


def _report_mismatch(publisher: TopicPublisher, subscription: TopicSubscription) -> None:
    """Warns both nodes of a mismatch: ROS 2's own message, then an explanation."""
    mismatch = _mismatch(publisher, subscription)
    if mismatch is None:
        return
    topic = publisher.topic_name
    if isinstance(mismatch, str):
        types = (type_name(publisher.msg_type), type_name(subscription.msg_type))
        if subscription.handle.name == WORLD_NODE_NAME and types == STAMPED_COMMAND:
            return
        warning = f"topic '{topic}' has two types, nothing will be received: {mismatch}"
        publisher.events.report_incompatible_type(warning)
        subscription.events.report_incompatible_type(warning)
        return
    offered, asked = (_setting(endpoint, mismatch) for endpoint in (publisher, subscription))
    why = (
        f" (the publisher of {publisher.handle.full_name} offers {offered}, "
        f"the subscription of {subscription.handle.full_name} asks for {asked})"
    )
    publisher.events.report_incompatible_qos(
        mismatch,
        f"New subscription discovered on topic '{topic}', requesting incompatible QoS. "
        f"No messages will be sent to it. Last incompatible policy: {mismatch.name}{why}",
    )
    subscription.events.report_incompatible_qos(
        mismatch,
        f"New publisher discovered on topic '{topic}', offering incompatible QoS. "
        f"No messages will be received from it. Last incompatible policy: {mismatch.name}{why}",
    )


def _setting(endpoint: GraphEndpoint, policy: QoSPolicyKind) -> str:
    """The endpoint's setting of a policy, as text."""
    setting = getattr(endpoint.qos_profile, policy.name.lower())
    if isinstance(setting, Duration):
        return f"{setting.nanoseconds / 1e9:g} s" if setting.nanoseconds else "none"
    return str(getattr(setting, "name", setting))


class Directory:
    """All nodes and endpoints of a graph. Change it with the graph's lock held."""

    def __init__(self, log: LoggerSettings, notify: Callable[[], None]) -> None:
        """``notify`` wakes waiting threads when a service appears."""
        self._log = log
        self._notify = notify
        self.version = 0
        """Increases with every node and endpoint that is added or removed."""
        self.nodes: tuple[NodeEntry, ...] = ()
        self.replaced_names: frozenset[str] = frozenset()
        """Full names of nodes that are about to leave: a new one of the same name takes its place."""
        self.topics: dict[str, Topic] = {}
        self.subscribed_topics: set[str] = set()
        """The absolute names of the topics that have subscriptions."""
        self.excesses: dict[tuple[str, str, str], Excess] = {}
        """The first command that asked for more than is carried out, by node, topic and field of the message."""
        self.command_limits: dict[str, tuple[str, ...]] = {}
        """The most that is carried out of each field of a command, as text, by the topic on which it is taken."""
        self.services: dict[str, list[ServiceServer]] = {}
        self.clients: dict[str, list[ServiceClient]] = {}

    def add_node(self, handle: NodeEntry) -> None:
        is_there = any(other.full_name == handle.full_name for other in self.nodes)
        if is_there and handle.full_name not in self.replaced_names:
            self._log.warning(
                "rcl",
                f"there is already a node called {handle.full_name}; two of one name get in each other's way",
            )
        self.nodes = (*self.nodes, handle)
        self.version += 1

    def remove_node(self, handle: NodeEntry) -> None:
        self.nodes = tuple(other for other in self.nodes if other is not handle)
        self.version += 1

    def find_node(self, name: str, namespace: str) -> NodeEntry | None:
        """The first node of this name, or None."""
        for handle in self.nodes:
            if handle.name == name and handle.namespace == namespace:
                return handle
        return None

    def get_or_create_topic(self, name: str) -> Topic:
        """The topic of this absolute name, made if necessary, so that an endpoint can be added to it."""
        self.version += 1
        return self.topics.setdefault(name, Topic(name, self.subscribed_topics))

    def note_endpoint(self) -> None:
        """To be called when a topic's new endpoint has been added to its node: others may have looked in between, since
        a mismatch of types is logged, and a log is a message."""
        self.version += 1

    def note_command_limits(self, topic: str, most: tuple[str, ...]) -> None:
        """Notes the most that is carried out of commands on a topic; nothing, if it is empty, is known of it."""
        if most:
            self.command_limits[topic] = most
        else:
            self.command_limits.pop(topic, None)
        self.version += 1

    def note_excess(self, node: str, topic: str, field: str, excess: Excess) -> None:
        """Keeps the first command of a node on a topic that asked for more in a field than is carried out."""
        if (node, topic, field) not in self.excesses and len(self.excesses) < MAX_EXCESSES:
            self.excesses[node, topic, field] = excess
            self.version += 1

    def remove_endpoint(self, endpoint: GraphEndpoint) -> None:
        self.version += 1
        topic = self.topics[endpoint.topic_name]
        topic.remove(endpoint)
        if not topic.publishers and not topic.subscriptions:
            del self.topics[endpoint.topic_name]

    def note_liveliness(self, publisher: TopicPublisher) -> None:
        """Is told that a publisher has come to life, or that its lease has run out."""
        self.version += 1
        self.topics[publisher.topic_name].count_alive()
        self._notify()

    def add_service(self, service: ServiceServer) -> None:
        self.version += 1
        self.services.setdefault(service.service_name, []).append(service)
        self._notify()

    def remove_service(self, service: ServiceServer) -> None:
        self.version += 1
        _remove_from(self.services, service.service_name, service)
        if self.find_server(service.service_name, service.srv_type) is None:
            for client in self.clients.get(service.service_name, ()):
                if client.srv_type is service.srv_type:
                    client.report_lost_server()

    def add_client(self, client: ServiceClient) -> None:
        self.version += 1
        self.clients.setdefault(client.service_name, []).append(client)

    def remove_client(self, client: ServiceClient) -> None:
        self.version += 1
        _remove_from(self.clients, client.service_name, client)

    def find_server(self, name: str, srv_type: type[Any]) -> ServiceServer | None:
        """The server that answers requests: the first of this name and type, or None."""
        for service in self.services.get(name, ()):
            if service.srv_type is srv_type:
                return service
        return None

    def topic_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Sorted by name."""
        return [(name, topic.type_names) for name, topic in sorted(self.topics.items())]

    def service_names_and_types(self) -> list[tuple[str, list[str]]]:
        """The services that have a server, sorted by name."""
        return [
            (name, sorted({type_name(service.srv_type) for service in servers}))
            for name, servers in sorted(self.services.items())
        ]

    def publishers(self, topic: str) -> Iterator[TopicPublisher]:
        found = self.topics.get(topic)
        yield from found.publishers if found is not None else ()

    def subscriptions(self, topic: str) -> Iterator[TopicSubscription]:
        found = self.topics.get(topic)
        yield from found.subscriptions if found is not None else ()

    def matching_qos(self, topic: str) -> QoSProfile:
        """A subscription's profile that matches every publisher of a topic; transient local if all of them are."""
        profiles = [publisher.qos_profile for publisher in self.publishers(topic)]
        is_reliable = all(not profile.is_best_effort for profile in profiles)
        is_durable = bool(profiles) and all(profile.is_transient_local for profile in profiles)
        return QoSProfile(
            history=HistoryPolicy.KEEP_ALL,
            reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if is_durable else DurabilityPolicy.VOLATILE,
        )


def _remove_from(endpoints: dict[str, list[Registered]], name: str, endpoint: ServiceEndpoint) -> None:
    rest = [other for other in endpoints[name] if other is not endpoint]
    if rest:
        endpoints[name] = rest
    else:
        del endpoints[name]
