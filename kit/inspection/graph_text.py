"""What ``kit ros node``, ``topic`` and ``service`` print of a graph, as ROS 2 does."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from kit.msg.interfaces import find_message
from kit.msg.message import type_name
from kit.plain_text import counted
from kit.ros.graph.action_names import NamesAndTypes, called_actions, served_actions
from kit.ros.graph.directory import NodeEntry
from kit.ros.graph.graph import Graph
from kit.ros.graph.naming import topic_or_service_is_hidden
from kit.ros.node.endpoint import TopicEndpointInfo, TopicEndpointTypeEnum
from kit.ros.node.qos import HistoryPolicy, LivelinessPolicy
from kit.ros.node.time import Duration
from kit.ros.serialization import Serializer


def node_names(graph: Graph, *, hidden: bool) -> list[str]:
    """Full names, sorted; a hidden node's own name begins with an underscore."""
    handles = graph.directory.nodes
    return sorted(handle.full_name for handle in handles if hidden or not handle.name.startswith("_"))


def absolute_name(name: str) -> str:
    """The name of a node or topic with a leading slash."""
    return name if name.startswith("/") else f"/{name}"


def topics(graph: Graph, *, hidden: bool) -> NamesAndTypes:
    found = graph.directory.topic_names_and_types()
    return [entry for entry in found if hidden or not topic_or_service_is_hidden(entry[0])]


def services(graph: Graph, *, hidden: bool) -> NamesAndTypes:
    found = graph.directory.service_names_and_types()
    return [entry for entry in found if hidden or not topic_or_service_is_hidden(entry[0])]


def node_info(handle: NodeEntry, *, hidden: bool) -> Iterator[str]:
    """The lines of ``node info``: an empty section holds an empty line, as in ROS 2."""
    yield handle.full_name
    sections: tuple[tuple[str, Iterable[tuple[str, str]]], ...] = (
        ("Subscribers", ((end.topic_name, type_name(end.msg_type)) for end in handle.subscriptions)),
        ("Publishers", ((end.topic_name, type_name(end.msg_type)) for end in handle.publishers)),
        ("Service Servers", ((end.service_name, type_name(end.srv_type)) for end in handle.services)),
        ("Service Clients", ((end.service_name, type_name(end.srv_type)) for end in handle.clients)),
        ("Action Servers", _flatten_types(served_actions(handle))),
        ("Action Clients", _flatten_types(called_actions(handle))),
    )
    for title, ends in sections:
        yield f"  {title}:"
        types: dict[str, set[str]] = {}
        for name, type_of in ends:
            if hidden or not topic_or_service_is_hidden(name):
                types.setdefault(name, set()).add(type_of)
        yield "\n".join(f"    {name}: {', '.join(sorted(types[name]))}" for name in sorted(types))


def _flatten_types(names_and_types: NamesAndTypes) -> Iterator[tuple[str, str]]:
    return ((name, each) for name, types in names_and_types for each in types)


def topic_summary(graph: Graph, names_and_types: NamesAndTypes) -> Iterator[str]:
    """The lines of ``topic list -v``."""
    for title, word, count_of in (
        ("Published", "publisher", graph.directory.publishers),
        ("Subscribed", "subscriber", graph.directory.subscriptions),
    ):
        yield f"{title} topics:"
        for name, types in names_and_types:
            count = sum(1 for _ in count_of(name))
            if count:
                yield f" * {name} [{', '.join(types)}] {counted(count, word)}"
        yield ""


def topic_info(graph: Graph, name: str, types: list[str], *, verbose: bool) -> Iterator[str]:
    """The lines of ``topic info``."""
    yield f"Type: {types[0] if len(types) == 1 else types}"
    for title, kind, ends in (
        ("Publisher", TopicEndpointTypeEnum.PUBLISHER, list(graph.directory.publishers(name))),
        ("Subscription", TopicEndpointTypeEnum.SUBSCRIPTION, list(graph.directory.subscriptions(name))),
    ):
        if verbose:
            yield ""
        yield f"{title} count: {len(ends)}"
        if verbose:
            for end in ends:
                yield ""
                yield from _endpoint_lines(TopicEndpointInfo.of(end, kind))
    if verbose:
        yield ""


def _endpoint_lines(info: TopicEndpointInfo) -> Iterator[str]:
    qos = info.qos_profile
    history = qos.history.name + (f" ({qos.depth})" if qos.history == HistoryPolicy.KEEP_LAST else "")
    liveliness = qos.liveliness
    if liveliness == LivelinessPolicy.SYSTEM_DEFAULT:
        liveliness = LivelinessPolicy.AUTOMATIC
    yield f"Node name: {info.node_name}"
    yield f"Node namespace: {info.node_namespace}"
    yield f"Topic type: {info.topic_type}"
    yield f"Topic type hash: {Serializer().type_hash(find_message(info.topic_type))}"
    yield f"Endpoint type: {info.endpoint_type.name}"
    yield f"GID: {'.'.join(f'{part:02x}' for part in info.endpoint_gid)}"
    yield "QoS profile:"
    yield f"  Reliability: {qos.reliability.name}"
    yield f"  History (Depth): {history}"
    yield f"  Durability: {qos.durability.name}"
    yield f"  Lifespan: {_duration_text(qos.lifespan)}"
    yield f"  Deadline: {_duration_text(qos.deadline)}"
    yield f"  Liveliness: {liveliness.name}"
    yield f"  Liveliness lease duration: {_duration_text(qos.liveliness_lease_duration)}"


def _duration_text(duration: Duration) -> str:
    return "Infinite" if duration.nanoseconds == 0 else f"{duration.nanoseconds} nanoseconds"


def service_info(graph: Graph, name: str, types: list[str]) -> Iterator[str]:
    """The lines of ``service info``."""
    yield f"Type: {types[0] if len(types) == 1 else types}"
    yield f"Clients count: {len(graph.directory.clients.get(name, ()))}"
    yield f"Services count: {len(graph.directory.services.get(name, ()))}"


# The kit's own note to itself in the texts that it ships.
