"""Proxies of another process's nodes in a graph, and the changes among a graph's own nodes.

Each side runs its own nodes and keeps proxies of the other side's: real nodes with real endpoints, except that what
arrives at them is passed on instead of being queued for a callback. Both sides exchange the same events:

    node id name namespace                       a node of the sender's
    publisher | subscription id node topic type qos
    service | client id node name type
    alive id whether                             of a publisher of MANUAL_BY_TOPIC
    gone id
    interface name lines                         of a workspace's definition, before the endpoints that need it; where both sides share them
    message id data                              from or for an endpoint of the child's
    request id number data                       likewise; the number is the caller's
    response id number data
"""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from typing import Any, Final, NamedTuple, Protocol, TypeVar, cast

from kit.host.wire import MAX_ID, MAX_NAME, Json, ProtocolError, integer, items, text
from kit.msg.definition_writer import definitions_of
from kit.msg.interfaces import (
    DefinitionError,
    Interface,
    ReceivedInterfaces,
    UnknownInterface,
    find_interface_or_event,
)
from kit.msg.message import Message, ServiceType, make_message_class, type_name
from kit.msg.message import Service as Definition
from kit.ros.exceptions import NameValidationException
from kit.ros.execution.callback_groups import MutuallyExclusiveCallbackGroup
from kit.ros.execution.context import context_of
from kit.ros.graph.directory import NodeEntry, TopicSubscription
from kit.ros.graph.graph import Graph
from kit.ros.graph.naming import validate_full_topic_name, validate_namespace, validate_node_name
from kit.ros.node.client import Client
from kit.ros.node.events import PublisherEventCallbacks, SubscriptionEventCallbacks
from kit.ros.node.node import Node
from kit.ros.node.publisher import Publisher
from kit.ros.node.qos import QoSProfile
from kit.ros.node.service import Call, Service
from kit.ros.node.subscription import Subscription
from kit.ros.parameters.parameter import Parameter

MAX_ENDPOINTS: Final = 2000
"""Nodes and endpoints that one student's program may have."""
MAX_MADE: Final = 25 * MAX_ENDPOINTS
"""Nodes and endpoints that it may make in all, one after the other: whoever watches the graph remembers their names."""

MAX_LINES: Final = 2000
"""Lines of the definition of an interface."""
MAX_LINE: Final = 10_000
"""Characters of one of them."""

AnyEndpoint = Publisher[Any] | Subscription[Any] | Service[Any, Any] | Client[Any, Any]
E = TypeVar("E", bound=AnyEndpoint)


class ReservedNameError(ProtocolError):
    """A program has given a node of its own a name that belongs to a node of the run, such as the world's."""

    def __init__(self, name: str) -> None:
        super().__init__(f"the node name {name} is reserved for the run: give your node another name.")


class ForeignNameError(ProtocolError):
    """A program has used a name that is not its own, in a run in which several programs have a namespace each."""

    def __init__(self, kind: str, name: str, namespace: str) -> None:
        super().__init__(
            f"a {kind} named {name} is not its own: in this run a program may use names below {namespace} alone, as it does "
            "with names that begin without a slash."
        )


class NameScope(NamedTuple):
    """The names that a program may use in a run with several programs: those below its namespace, and a few more."""

    namespace: str
    """``/first``"""
    heard: frozenset[str] = frozenset(("/clock", "/tf", "/tf_static"))
    """Topics that it may subscribe to."""
    told: frozenset[str] = frozenset(("/rosout", "/parameter_events"))
    """Topics that it may publish on and subscribe to."""

    def check(self, kind: str, name: str) -> None:
        """``kind``: ``node``, ``publisher``, ``subscription``, ``service`` or ``client``. Raises ForeignNameError."""
        is_heard = kind == "subscription" and name in self.heard
        is_told = kind in ("publisher", "subscription") and name in self.told
        if not (is_heard or is_told or name.startswith(f"{self.namespace}/")):
            raise ForeignNameError(kind, name, self.namespace)


class ProxyListener(Protocol):
    """Is told what arrives at a proxy; endpoints are named by their numbers on their own side."""

    def on_message(self, subscription: int, message: Message) -> None: ...

    def on_request(self, service: int, call: Call) -> None: ...

    def on_response(self, client: int, number: int, response: Message) -> None: ...

    def on_discard(self, endpoint: int) -> None:
        """Drops what waits to be sent to this endpoint."""


class ProxyNode(Node):
    """A node of the other side's, without a node's usual endpoints."""

    def __init__(self, graph: Graph, name: str, namespace: str) -> None:
        super().__init__(
            name,
            context=context_of(graph),
            namespace=namespace,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        for publisher in list(self.publishers):
            self.destroy_publisher(publisher)

    def declare_parameter(self, name: str, value: Any = None, *_: Any, **__: Any) -> Parameter:
        """Does nothing: its parameters are on the other side."""
        return Parameter(name, value=value)


class _ProxyEndpoint:
    """Mixin of endpoints that pass what arrives to a listener at once, instead of queueing it."""

    def __init__(self, number: int, listener: ProxyListener, *arguments: Any) -> None:
        """``number``: the endpoint's on its own side. ``arguments``: those of the endpoint's class."""
        self._remote_number = number
        self._listener = listener
        super().__init__(*arguments)

    def discard_queue(self) -> None:
        self._listener.on_discard(self._remote_number)


class ProxyPublisher(Publisher[Any]):
    """A publisher of the other side's. Its own subscriptions have what it keeps already: it has sent it to them there."""

    def __init__(self, others: Container[NodeEntry], *args: Any) -> None:
        """``others``: the nodes of the other side."""
        self._others = others
        super().__init__(*args)

    def _make_lease(self) -> None:
        """Has none: the other side says when it is alive."""

    def send_history_to(self, subscription: TopicSubscription) -> None:
        if subscription.handle not in self._others:
            super().send_history_to(subscription)


class ProxySubscription(_ProxyEndpoint, Subscription[Any]):
    """Passes each message on at once."""

    def enqueue(self, msg: Message) -> None:
        self._listener.on_message(self._remote_number, msg)


class ProxyService(_ProxyEndpoint, Service[Any, Any]):
    """Passes each request on at once; the response comes by ``call.client.enqueue``."""

    def enqueue(self, call: Call) -> None:
        self._listener.on_request(self._remote_number, call)


class ProxyClient(_ProxyEndpoint, Client[Any, Any]):
    """Passes each response on at once."""

    def send_request(self, number: int, request: Message) -> None:
        """Passes a request to the service of this name. Without one it stays without a response, as in ROS 2."""
        graph = self._graph
        with graph.lock:
            if graph.message_listeners:
                graph.notify_message_listeners(self._handle.node, self.service_name, request)
            server = graph.directory.find_server(self.service_name, self.srv_type)
            if server is not None:
                server.enqueue(Call(self, number, request))
                graph.notify()

    def enqueue(self, number: int, response: Any) -> None:
        self._listener.on_response(self._remote_number, number, response)


def _never_called(request: Any, response: Any = None) -> Any:
    raise AssertionError("a proxy has no callback")


class ProxyNodes:
    """The other side's nodes and endpoints. Events are checked: raises ProtocolError, ReservedNameError,
    ForeignNameError."""

    def __init__(
        self,
        graph: Graph,
        listener: ProxyListener,
        *,
        allow_unknown_types: bool = False,
        shares_interfaces: bool = False,
        scope: NameScope | None = None,
    ) -> None:
        """``allow_unknown_types``: an endpoint may have an interface that this process has no definition of;
        ``shares_interfaces``: the other side sends definitions; ``scope``: the names that it may use, by default all."""
        self._scope = scope
        self._interfaces = ReceivedInterfaces() if shares_interfaces else None
        self._graph = graph
        self._listener = listener
        self._allow_unknown_types = allow_unknown_types
        self._nodes: dict[int, ProxyNode] = {}
        self._handles: set[NodeEntry] = set()
        self._endpoints: dict[int, AnyEndpoint] = {}
        self._types: dict[str, Interface] = {}
        self._made = 0

    def __contains__(self, handle: NodeEntry) -> bool:
        return handle in self._handles

    @property
    def node_names(self) -> frozenset[str]:
        """The full names of the nodes."""
        return frozenset(handle.full_name for handle in self._handles)

    def endpoint(self, identity: Json, kind: type[E]) -> E:
        """Returns the endpoint with this number. Raises ProtocolError if there is none of that kind."""
        endpoint = self._endpoints.get(integer(identity, 0, MAX_ID))
        if not isinstance(endpoint, kind):
            raise ProtocolError(f"no {kind.__name__.lower()} has the number {identity}")
        return endpoint

    def apply_event(self, name: str, fields: list[Json]) -> None:
        """Applies a change among the other side's nodes: ``node``, one of the endpoints, or ``gone``."""
        if name == "interface" and self._interfaces is not None:
            self._add_interface(self._interfaces, *items(fields, 2))
            return
        if name == "alive":
            identity, is_alive = items(fields, 2)
            self.endpoint(identity, ProxyPublisher).set_alive(bool(is_alive))
            return
        if name == "gone":
            (identity,) = items(fields, 1)
            self._remove(integer(identity))
            return
        if len(self._nodes) + len(self._endpoints) >= MAX_ENDPOINTS:
            raise ProtocolError(
                f"more than {MAX_ENDPOINTS} nodes, publishers, subscriptions, services and clients"
            )
        if self._made >= MAX_MADE:
            raise ProtocolError(
                f"more than {MAX_MADE} nodes, publishers, subscriptions, services and clients, one after the other"
            )
        self._made += 1
        if name == "node":
            self._add_node(*items(fields, 3))
        elif name in ("publisher", "subscription"):
            self._add_topic_endpoint(name, *items(fields, 5))
        else:
            self._add_service_endpoint(name, *items(fields, 4))

    def clear(self) -> None:
        """Removes all of them from the graph."""
        for node in self._nodes.values():
            node.destroy_node()
        self._nodes.clear()
        self._handles.clear()
        self._endpoints.clear()

    def _add_node(self, identity: Json, name: Json, namespace: Json) -> None:
        node_name, space = text(name, MAX_NAME), text(namespace, MAX_NAME)
        _check_name(validate_node_name, node_name)
        _check_name(validate_namespace, space)
        number = self._check_new(identity)
        full_name = f"{space.rstrip('/')}/{node_name}"
        if full_name in self._graph.reserved_names:
            raise ReservedNameError(full_name)
        self._check_scope("node", full_name)
        self._nodes[number] = node = ProxyNode(self._graph, node_name, space)
        self._handles.add(node.handle)

    def _add_topic_endpoint(
        self, kind: str, identity: Json, node: Json, topic: Json, type_text: Json, qos: Json
    ) -> None:
        handle, name, profile = self._find_node(node).handle, text(topic, MAX_NAME), _read_qos(qos)
        cls = self._find_type(type_text, Message)
        _check_name(validate_full_topic_name, name)
        self._check_scope(kind, name)
        number = self._check_new(identity)
        if kind == "publisher":
            quiet = PublisherEventCallbacks(use_default_callbacks=False)
            publisher: Publisher[Any] = ProxyPublisher(self._handles, handle, cls, name, profile, quiet)
            handle.publishers.append(publisher)
            self._endpoints[number] = publisher
        else:
            group = MutuallyExclusiveCallbackGroup()
            quiet_subscription = SubscriptionEventCallbacks(use_default_callbacks=False)
            subscription = ProxySubscription(
                number, self._listener, handle, cls, name, _never_called, group, profile, quiet_subscription
            )
            handle.subscriptions.append(subscription)
            self._endpoints[number] = subscription

    def _add_service_endpoint(
        self, kind: str, identity: Json, node: Json, name: Json, type_text: Json
    ) -> None:
        handle, service_name = self._find_node(node).handle, text(name, MAX_NAME)
        cls = self._find_type(type_text, Definition)
        _check_name(validate_full_topic_name, service_name)
        self._check_scope(kind, service_name)
        number = self._check_new(identity)
        profile, group = QoSProfile(depth=10), MutuallyExclusiveCallbackGroup()
        if kind == "service":
            service = ProxyService(
                number, self._listener, handle, cls, service_name, _never_called, group, profile
            )
            handle.services.append(service)
            self._endpoints[number] = service
        elif kind == "client":
            client = ProxyClient(number, self._listener, handle, cls, service_name, group, profile)
            handle.clients.append(client)
            self._endpoints[number] = client
        else:
            raise ProtocolError(f"no such kind of event: {kind}")

    def _remove(self, identity: int) -> None:
        if identity in self._nodes:
            node = self._nodes.pop(identity)
            self._endpoints = {
                number: endpoint
                for number, endpoint in self._endpoints.items()
                if endpoint.handle is not node.handle
            }
            self._handles.discard(node.handle)
            node.destroy_node()
        elif identity in self._endpoints:
            self._endpoints.pop(identity).destroy()
        else:
            raise ProtocolError(f"nothing has the number {identity}, which is gone")

    def _check_scope(self, kind: str, name: str) -> None:
        if self._scope is not None:
            self._scope.check(kind, name)

    def _check_new(self, identity: Json) -> int:
        number = integer(identity)
        if number in self._nodes or number in self._endpoints:
            raise ProtocolError(f"the number {number} twice")
        return number

    def _add_interface(self, interfaces: ReceivedInterfaces, name: Json, definition: Json) -> None:
        try:
            lines = items(definition)
            if len(lines) > MAX_LINES:
                raise ProtocolError(f"an interface of more than {MAX_LINES} lines")
            interfaces.add(text(name, MAX_NAME), "\n".join(text(line, MAX_LINE) for line in lines))
        except DefinitionError as problem:
            raise ProtocolError(str(problem)) from None
        self._made += 1
        self._types.clear()

    def _find_node(self, identity: Json) -> ProxyNode:
        node = self._nodes.get(integer(identity))
        if node is None:
            raise ProtocolError(f"no node has the number {identity}")
        return node

    def _find_type(self, content: Json, kind: type[Any]) -> Any:
        name = text(content, MAX_NAME)
        if name not in self._types:
            find = find_interface_or_event if self._interfaces is None else self._interfaces.find
            try:
                self._types[name] = find(name)
            except (UnknownInterface, DefinitionError) as problem:
                if self._allow_unknown_types:
                    self._types[name] = _undefined_interface(name, kind)
                    return self._types[name]
                raise ProtocolError(f"{name}, a type that the kit does not have: {problem}") from None
        cls = self._types[name]
        if not issubclass(cls, kind):
            raise ProtocolError(f"{name} in the wrong place")
        return cls


def _undefined_interface(name: str, kind: type[Any]) -> Interface:
    """A class without fields that stands for an interface of another workspace: it is listed, but never used."""
    own_name = name.rpartition("/")[2]
    if issubclass(kind, Message):
        return make_message_class(name, (), is_custom=True)
    attributes = {"__ros_type__": name, "__ros_custom__": True, "Request": Message, "Response": Message}
    return cast(Interface, ServiceType(own_name, (Definition,), attributes))


class GraphDiff:
    """Detects which of this side's own nodes and endpoints are new, and which are gone."""

    def __init__(self, graph: Graph, proxies: ProxyNodes, *, shares_interfaces: bool) -> None:
        self._graph = graph
        self._proxies = proxies
        self._sent_definitions: dict[str, str] | None = {} if shares_interfaces else None
        self._version = -1
        self._nodes: dict[NodeEntry, int] = {}
        self._publishers: dict[tuple[NodeEntry, str, type[Any]], int] = {}
        """Publishers by node, topic and type: a node may publish two types on one topic."""
        self.endpoints: dict[int, AnyEndpoint] = {}
        """This side's own endpoints by number."""
        self._liveliness: dict[int, bool | None] = {}
        """Whether publishers with a lease are alive, as the other side knows it."""

    @property
    def has_changed(self) -> bool:
        return self._version != self._graph.directory.version

    def mark_seen(self) -> None:
        """Ignores all changes up to now: they came from the other side."""
        self._version = self._graph.directory.version

    def take_changes(self) -> list[Json]:
        """Returns the events for all changes since the last call."""
        if not self.has_changed:
            return []
        self.mark_seen()
        events: list[Json] = []
        present: set[int] = set()
        for handle in self._graph.directory.nodes:
            if handle in self._proxies:
                continue
            if handle not in self._nodes:
                self._nodes[handle] = self._graph.next_number()
                events.append(["node", self._nodes[handle], handle.name, handle.namespace])
            node = self._nodes[handle]
            present.add(node)
            for kind, endpoints in _endpoints_by_kind(handle):
                for endpoint in endpoints:
                    present.add(endpoint.number)
                    if endpoint.number not in self.endpoints:
                        self.endpoints[endpoint.number] = endpoint
                        events += self._interface_events(endpoint)
                        events.append([kind, endpoint.number, node, *_describe(endpoint)])
            for publisher in handle.publishers:
                if publisher.has_lease and publisher.is_alive is not self._liveliness.get(publisher.number):
                    self._liveliness[publisher.number] = publisher.is_alive
                    events.append(["alive", publisher.number, publisher.is_alive])
        lost = [number for number in (*self.endpoints, *self._nodes.values()) if number not in present]
        # Where a node of the same name has come, the other one went before it.
        names = {handle.full_name for handle, number in self._nodes.items() if number in present}
        replaced = {
            handle
            for handle, number in self._nodes.items()
            if number not in present and handle.full_name in names
        }
        early = {number for number, endpoint in self.endpoints.items() if endpoint.handle in replaced}
        early |= {self._nodes[handle] for handle in replaced}
        first = [["gone", number] for number in lost if number in early]
        events = [*first, *events, *(["gone", number] for number in lost if number not in early)]
        self.endpoints = {
            number: endpoint for number, endpoint in self.endpoints.items() if number in present
        }
        self._nodes = {handle: number for handle, number in self._nodes.items() if number in present}
        self._publishers = {
            (endpoint.handle, endpoint.topic_name, endpoint.msg_type): number
            for number, endpoint in self.endpoints.items()
            if isinstance(endpoint, Publisher)
        }
        return events

    def _interface_events(self, endpoint: AnyEndpoint) -> list[Json]:
        """The definitions that the other side needs for an endpoint and has not been sent."""
        sent = self._sent_definitions
        if sent is None:
            return []
        if isinstance(endpoint, (Publisher, Subscription)):
            found = definitions_of(endpoint.msg_type)
        else:
            found = definitions_of(endpoint.srv_type)
        events: list[Json] = [
            ["interface", name, text.split("\n")] for name, text in found.items() if sent.get(name) != text
        ]
        sent.update(found)
        return events

    def publisher_number(self, handle: NodeEntry, topic: str, message_type: type[Any]) -> int:
        """Returns the number of a node's publisher of a topic that sends messages of this type."""
        keys = ((handle, topic, each) for each in message_type.__mro__)
        return next(self._publishers[key] for key in keys if key in self._publishers)


def _endpoints_by_kind(handle: NodeEntry) -> list[tuple[str, Sequence[Any]]]:
    return [
        ("publisher", handle.publishers),
        ("subscription", handle.subscriptions),
        ("service", handle.services),
        ("client", handle.clients),
    ]


def _describe(endpoint: AnyEndpoint) -> list[Json]:
    if isinstance(endpoint, (Publisher, Subscription)):
        return [endpoint.topic_name, type_name(endpoint.msg_type), endpoint.qos_profile.numbers]
    return [endpoint.service_name, type_name(endpoint.srv_type)]


def _read_qos(content: Json) -> QoSProfile:
    numbers = [integer(value, 0, 2**63 - 1) for value in items(content, len(QoSProfile.WIRED))]
    try:
        return QoSProfile.from_numbers(numbers)
    except ValueError:
        raise ProtocolError(f"not a quality of service: {content}") from None


def _check_name(check: Callable[[str], bool], name: str) -> None:
    try:
        check(name)
    except NameValidationException as problem:
        raise ProtocolError(f"{name}: {problem.error_msg}") from None
