"""One side's nodes in the other side's graph, so that both see one and the same graph.

Each side runs its own nodes and keeps a *mirror* of the other side's: real nodes with real endpoints, except
that what arrives at them is handed on instead of being kept for a callback. A *census* notices what has changed
among a side's own nodes and tells the other side. Both directions use both, and the same events:

    node id name namespace                       one of my nodes is there
    publisher | subscription id node topic type qos
    service | client id node name type
    gone id
    message id data                              from or for an endpoint of the student's side
    request id number data                       likewise; the number is the asking side's
    response id number data
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Final, Protocol, TypeVar

from kit.host.wire import MAX_ID, MAX_NAME, Json, ProtocolError, integer, items, text
from kit.msg.interfaces import Interface, UnknownInterface, find_interface
from kit.msg.message import Message, type_name
from kit.msg.message import Service as Definition
from kit.ros.exceptions import NameValidationException
from kit.ros.execution.callback_groups import MutuallyExclusiveCallbackGroup
from kit.ros.execution.context import context_of
from kit.ros.graph.naming import validate_full_topic_name, validate_namespace, validate_node_name
from kit.ros.node.client import Client
from kit.ros.node.endpoint import PublisherEventCallbacks, SubscriptionEventCallbacks
from kit.ros.node.node import Node
from kit.ros.node.publisher import Publisher
from kit.ros.node.qos import QoSProfile
from kit.ros.node.service import Call, Service
from kit.ros.node.subscription import Subscription
from kit.ros.parameters.parameter import Parameter

if TYPE_CHECKING:
    from kit.ros.graph.directory import NodeEntry
    from kit.ros.graph.graph import Graph
    from kit.ros.node.node_handle import NodeHandle

MOST: Final = 2000
"""Nodes and endpoints that one student's program may have."""

End = Publisher[Any] | Subscription[Any] | Service[Any, Any] | Client[Any, Any]
E = TypeVar("E", bound=End)


class ProxyListener(Protocol):
    """What to do with what reaches a mirrored endpoint, named by its number on its own side."""

    def on_message(self, subscription: int, message: Message) -> None: ...

    def on_request(self, service: int, call: Call) -> None: ...

    def on_response(self, client: int, number: int, response: Message) -> None: ...

    def on_discard(self, end: int) -> None:
        """What is on its way to this endpoint is to be forgotten."""


class ProxyNode(Node):
    """A node that lives on the other side. It has nothing of its own, not even a node's usual endpoints."""

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


class ProxySubscription(Subscription[Any]):
    """Hands on each message at once."""

    def __init__(
        self,
        node: NodeHandle,
        cls: type[Message],
        topic: str,
        qos: QoSProfile,
        identity: int,
        listener: ProxyListener,
    ) -> None:
        self._identity, self._listener = identity, listener
        quiet = SubscriptionEventCallbacks(use_default_callbacks=False)
        super().__init__(node, cls, topic, _never_called, MutuallyExclusiveCallbackGroup(), qos, quiet)

    def enqueue(self, msg: Message) -> None:
        self._listener.on_message(self._identity, msg)

    def discard_queue(self) -> None:
        self._listener.on_discard(self._identity)


class ProxyService(Service[Any, Any]):
    """Hands on each request at once; whoever answers calls ``call.client.enqueue``."""

    def __init__(
        self,
        node: NodeHandle,
        cls: type[Definition],
        name: str,
        qos: QoSProfile,
        identity: int,
        listener: ProxyListener,
    ) -> None:
        self._identity, self._listener = identity, listener
        super().__init__(node, cls, name, _never_called, MutuallyExclusiveCallbackGroup(), qos)

    def enqueue(self, call: Call) -> None:
        self._listener.on_request(self._identity, call)

    def discard_queue(self) -> None:
        self._listener.on_discard(self._identity)


class ProxyClient(Client[Any, Any]):
    """Hands on each response at once."""

    def __init__(
        self,
        node: NodeHandle,
        cls: type[Definition],
        name: str,
        qos: QoSProfile,
        identity: int,
        listener: ProxyListener,
    ) -> None:
        self._identity, self._listener = identity, listener
        super().__init__(node, cls, name, MutuallyExclusiveCallbackGroup(), qos)

    def ask(self, number: int, request: Message) -> None:
        """Passes a request on to whoever serves. Nobody: it stays without an answer, as in ROS 2."""
        graph = self._graph
        with graph.lock:
            if graph.message_listeners:
                graph.notify_message_listeners(self._handle.node, self.service_name, request)
            server = graph.directory.find_server(self.service_name, self.srv_type)
            if server is not None:
                server.enqueue(Call(self, number, request))
                graph.notify()

    def enqueue(self, number: int, response: Any) -> None:
        self._listener.on_response(self._identity, number, response)

    def discard_queue(self) -> None:
        self._listener.on_discard(self._identity)


def _never_called(request: Any, response: Any = None) -> Any:
    raise AssertionError("a mirrored endpoint has no callback")


class ProxyNodes:
    """The other side's nodes, as far as it has told of them. What it tells is checked (ProtocolError)."""

    def __init__(self, graph: Graph, listener: ProxyListener) -> None:
        self._graph = graph
        self._listener = listener
        self._nodes: dict[int, ProxyNode] = {}
        self._handles: set[NodeEntry] = set()
        self._ends: dict[int, End] = {}
        self._types: dict[str, Interface] = {}

    def __contains__(self, handle: NodeEntry) -> bool:
        return handle in self._handles

    def end(self, identity: Json, kind: type[E]) -> E:
        """The endpoint of this number."""
        end = self._ends.get(integer(identity, 0, MAX_ID))
        if not isinstance(end, kind):
            raise ProtocolError(f"no {kind.__name__.lower()} has the number {identity}")
        return end

    def take_in(self, name: str, fields: list[Json]) -> None:
        """Notes what the other side tells of itself: ``node``, one of the endpoints, or ``gone``."""
        if name == "gone":
            (identity,) = items(fields, 1)
            self._forget(integer(identity))
        elif len(self._nodes) + len(self._ends) >= MOST:
            raise ProtocolError(f"more than {MOST} nodes, publishers, subscriptions, services and clients")
        elif name == "node":
            self._add_node(*items(fields, 3))
        elif name in ("publisher", "subscription"):
            self._add_topic_end(name, *items(fields, 5))
        else:
            self._add_service_end(name, *items(fields, 4))

    def clear(self) -> None:
        """Takes all of them out of the graph."""
        for node in self._nodes.values():
            node.destroy_node()
        self._nodes.clear()
        self._handles.clear()
        self._ends.clear()

    def _add_node(self, identity: Json, name: Json, namespace: Json) -> None:
        node_name, space = text(name, MAX_NAME), text(namespace, MAX_NAME)
        _valid(validate_node_name, node_name)
        _valid(validate_namespace, space)
        number = self._new(identity)
        self._nodes[number] = node = ProxyNode(self._graph, node_name, space)
        self._handles.add(node.handle)

    def _add_topic_end(
        self, kind: str, identity: Json, node: Json, topic: Json, type_of: Json, qos: Json
    ) -> None:
        handle, name, profile = self._node(node).handle, text(topic, MAX_NAME), _read_qos(qos)
        cls = self._type(type_of, Message)
        _valid(validate_full_topic_name, name)
        number = self._new(identity)
        if kind == "publisher":
            quiet = PublisherEventCallbacks(use_default_callbacks=False)
            publisher: Publisher[Any] = Publisher(handle, cls, name, profile, quiet)
            handle.publishers.append(publisher)
            self._ends[number] = publisher
        else:
            subscription = ProxySubscription(handle, cls, name, profile, number, self._listener)
            handle.subscriptions.append(subscription)
            self._ends[number] = subscription

    def _add_service_end(self, kind: str, identity: Json, node: Json, name: Json, type_of: Json) -> None:
        handle, service_name = self._node(node).handle, text(name, MAX_NAME)
        cls = self._type(type_of, Definition)
        _valid(validate_full_topic_name, service_name)
        number = self._new(identity)
        profile = QoSProfile(depth=10)
        if kind == "service":
            service = ProxyService(handle, cls, service_name, profile, number, self._listener)
            handle.services.append(service)
            self._ends[number] = service
        elif kind == "client":
            client = ProxyClient(handle, cls, service_name, profile, number, self._listener)
            handle.clients.append(client)
            self._ends[number] = client
        else:
            raise ProtocolError(f"no such kind of event: {kind}")

    def _forget(self, identity: int) -> None:
        if identity in self._nodes:
            node = self._nodes.pop(identity)
            self._ends = {number: end for number, end in self._ends.items() if end.handle is not node.handle}
            self._handles.discard(node.handle)
            node.destroy_node()
        elif identity in self._ends:
            self._ends.pop(identity).destroy()
        else:
            raise ProtocolError(f"the end of something that never was: {identity}")

    def _new(self, identity: Json) -> int:
        number = integer(identity)
        if number in self._nodes or number in self._ends:
            raise ProtocolError(f"two things of one number: {number}")
        return number

    def _node(self, identity: Json) -> ProxyNode:
        node = self._nodes.get(integer(identity))
        if node is None:
            raise ProtocolError(f"no node has the number {identity}")
        return node

    def _type(self, content: Json, kind: type[Any]) -> Any:
        name = text(content, MAX_NAME)
        if name not in self._types:
            try:
                self._types[name] = find_interface(name)
            except UnknownInterface:
                raise ProtocolError(f"{name}, a type that the kit does not have") from None
        cls = self._types[name]
        if not issubclass(cls, kind):
            raise ProtocolError(f"{name} in the wrong place")
        return cls


class GraphDiff:
    """Tells what is new and what is gone among one side's own nodes."""

    def __init__(self, graph: Graph, mirror: ProxyNodes) -> None:
        self._graph = graph
        self._proxies = mirror
        self._version = -1
        self._nodes: dict[NodeEntry, int] = {}
        self._publishers: dict[tuple[NodeEntry, str], int] = {}
        self.ends: dict[int, End] = {}
        """This side's own endpoints by number."""

    @property
    def has_news(self) -> bool:
        return self._version != self._graph.directory.version

    def seen(self) -> None:
        """What has changed up to now came from the other side."""
        self._version = self._graph.directory.version

    def news(self) -> list[Json]:
        """The events since the last time."""
        if not self.has_news:
            return []
        self.seen()
        events: list[Json] = []
        living: set[int] = set()
        for handle in self._graph.directory.nodes:
            if handle in self._proxies:
                continue
            if handle not in self._nodes:
                self._nodes[handle] = self._graph.next_number()
                events.append(["node", self._nodes[handle], handle.name, handle.namespace])
            node = self._nodes[handle]
            living.add(node)
            for kind, ends in _ends(handle):
                for end in ends:
                    living.add(end.number)
                    if end.number not in self.ends:
                        self.ends[end.number] = end
                        events.append([kind, end.number, node, *_words(end)])
        lost = [number for number in (*self.ends, *self._nodes.values()) if number not in living]
        events += [["gone", number] for number in lost]
        self.ends = {number: end for number, end in self.ends.items() if number in living}
        self._nodes = {handle: number for handle, number in self._nodes.items() if number in living}
        self._publishers = {
            (end.handle, end.topic_name): number
            for number, end in self.ends.items()
            if isinstance(end, Publisher)
        }
        return events

    def publisher(self, handle: NodeEntry, topic: str) -> int:
        """The number of a node's publisher of a topic."""
        return self._publishers[handle, topic]


def _ends(handle: NodeEntry) -> list[tuple[str, Sequence[Any]]]:
    return [
        ("publisher", handle.publishers),
        ("subscription", handle.subscriptions),
        ("service", handle.services),
        ("client", handle.clients),
    ]


def _words(end: End) -> list[Json]:
    if isinstance(end, (Publisher, Subscription)):
        profile = end.qos_profile
        qos = [profile.history, profile.depth, profile.reliability, profile.durability]
        return [end.topic_name, type_name(end.msg_type), [int(value) for value in qos]]
    return [end.service_name, type_name(end.srv_type)]


def _read_qos(content: Json) -> QoSProfile:
    history, depth, reliability, durability = (integer(value, 0, 10**6) for value in items(content, 4))
    try:
        return QoSProfile(history=history, depth=depth, reliability=reliability, durability=durability)
    except ValueError:
        raise ProtocolError(f"no quality of service: {content}") from None


def _valid(check: Callable[[str], bool], name: str) -> None:
    try:
        check(name)
    except NameValidationException as problem:
        raise ProtocolError(f"{name}: {problem.error_msg}") from None
