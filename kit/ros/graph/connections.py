"""What the nodes of a program connect to, and what of it no other node offers or uses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, field
from typing import Final

from kit.msg.message import type_name
from kit.plain_text import join_names, nearest_name
from kit.ros.constants import CLOCK_TOPIC
from kit.ros.graph.directory import Directory, NodeEntry, describe_mismatch
from kit.ros.graph.graph import Graph

UNHEARD_BY_DESIGN: Final = frozenset({"/rosout", "/parameter_events"})
"""Topics that every node has and that need no other end."""
TRANSFORMS: Final = frozenset({"tf", "tf_static"})
"""The last words of the topics of transforms: who offers or reads transforms uses both, and one other end is enough."""
MAX_MISTAKES: Final = 3
MAX_NAMES: Final = 6
MAX_NOTED: Final = 1000
"""Publishers and subscriptions of all time that are noted."""


@dataclass(frozen=True, slots=True)
class NodeConnections:
    """The nodes that a program had when its episode ended, and what they and others connected to before."""

    nodes: tuple[str, ...] = ()
    """Full names of the nodes at the end, sorted."""
    mistakes: tuple[str, ...] = ()
    """Sentences about connections without another end, such as a subscription of a topic that nobody publishes, and about
    commands for more than the robot can."""
    heard: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Topics to which each node has subscribed at any time, sorted, without those that every node has."""
    profiles: tuple[str, ...] = ()
    """One line for each publisher and subscription of any time, ``/node publishes /topic RELIABLE VOLATILE 10``, sorted."""


class ConnectionsReader:
    """Reads the connections of the nodes that join a graph after this reader was made: those of the program."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._others = frozenset(graph.directory.nodes)
        self._noted_version = -1
        self._heard: dict[str, set[str]] = {}
        self._profiles: set[str] = set()

    def note(self) -> None:
        """Takes note of the connections of this moment, if they have changed. Of very many, the first are noted."""
        directory = self._graph.directory
        if directory.version == self._noted_version or len(self._profiles) > MAX_NOTED:
            return
        with self._graph.lock:
            self._noted_version = directory.version
            for handle in directory.nodes:
                if handle not in self._others:
                    self._heard.setdefault(handle.full_name, set()).update(_heard_topics(handle))
                    self._profiles.update(_profiles(handle))

    def read(self) -> NodeConnections:
        self.note()
        with self._graph.lock:
            names = frozenset(
                handle.full_name for handle in self._graph.directory.nodes if handle not in self._others
            )
            mistakes = (*find_mistakes(self._graph, names), *find_excesses(self._graph, names))
        heard = {name: tuple(sorted(topics)) for name, topics in self._heard.items()}
        return NodeConnections(
            tuple(sorted(names)), mistakes[:MAX_MISTAKES], heard, tuple(sorted(self._profiles))
        )


def find_mistakes(graph: Graph, names: Set[str]) -> tuple[str, ...]:
    """Returns the sentences of ``NodeConnections.mistakes`` about the nodes with these full names."""
    with graph.lock:
        handles = [handle for handle in graph.directory.nodes if handle.full_name in names]
        return tuple(mistake for handle in handles for mistake in _mistakes(graph.directory, handle))


def find_excesses(graph: Graph, names: Set[str]) -> tuple[str, ...]:
    """Returns a sentence about each of these nodes' commands for more than is carried out."""
    with graph.lock:
        return tuple(
            f"{node} asks for {excess.asked} on {topic}, where the robot does at most {excess.largest}."
            for (node, topic, _), excess in graph.directory.excesses.items()
            if node in names
        )


def _heard_topics(handle: NodeEntry) -> set[str]:
    return {subscription.topic_name for subscription in handle.subscriptions} - UNHEARD_BY_DESIGN


def _profiles(handle: NodeEntry) -> Iterator[str]:
    for verb, endpoints in (("publishes", handle.publishers), ("subscribes", handle.subscriptions)):
        for each in endpoints:
            if each.topic_name not in UNHEARD_BY_DESIGN:
                qos = each.qos_profile
                yield (
                    f"{handle.full_name} {verb} {each.topic_name} {qos.reliability.name} {qos.durability.name} "
                    f"{qos.depth}"
                )


def _mistakes(directory: Directory, handle: NodeEntry) -> Iterator[str]:
    for subscription in handle.subscriptions:
        name, kind = subscription.topic_name, type_name(subscription.msg_type)
        if name in UNHEARD_BY_DESIGN:
            continue
        published = _topics(directory, publishes=True)
        types = _types_of(name, published)
        if not types:
            yield f"{name}, to which {handle.full_name} subscribes, has no publisher; {_offer(name, kind, published)}."
        elif kind not in types:
            yield f"{handle.full_name} expects {kind} on {name}, which carries {', '.join(sorted(types))}."
        for publisher in directory.publishers(name):
            if publisher.msg_type is subscription.msg_type and (
                why := describe_mismatch(publisher, subscription)
            ):
                yield f"Nothing passes on {name}. {why}."
    for publisher in handle.publishers:
        name, kind = publisher.topic_name, type_name(publisher.msg_type)
        if name == CLOCK_TOPIC:
            yield f"{handle.full_name} publishes {name}, which no clock follows: here every node has the simulated time."
        if name in UNHEARD_BY_DESIGN:
            continue
        heard = _topics(directory, publishes=False)
        types = _types_of(name, heard)
        if types and kind not in types:
            yield f"{handle.full_name} publishes {kind} on {name}, where {', '.join(sorted(types))} is expected."
        elif not types and (others := _same_type(kind, heard)):
            yield (
                f"{name}, to which {handle.full_name} publishes, has no subscriber; {_of_its_type(others, kind)}."
            )
    for client in handle.clients:
        if directory.find_server(client.service_name, client.srv_type) is None:
            offered = {each: set(types) for each, types in directory.service_names_and_types()}
            kind = type_name(client.srv_type)
            yield f"{client.service_name}, which {handle.full_name} calls, is offered by no node; {_offer(client.service_name, kind, offered)}."


def _topics(directory: Directory, *, publishes: bool) -> dict[str, set[str]]:
    """Returns the types of the publishers, or of the subscriptions, of every topic that has some."""
    found = {}
    for name in directory.topics:
        ends = directory.publishers(name) if publishes else directory.subscriptions(name)
        types = {type_name(end.msg_type) for end in ends}
        if types and name not in UNHEARD_BY_DESIGN:
            found[name] = types
    return found


def _types_of(name: str, found: Mapping[str, set[str]]) -> set[str]:
    """The types of a topic's other ends; of transforms, those of the companion topic of the same namespace too."""
    namespace, _, word = name.rpartition("/")
    names = [f"{namespace}/{each}" for each in sorted(TRANSFORMS)] if word in TRANSFORMS else [name]
    return set[str]().union(*(found.get(each, set()) for each in names))


def _same_type(kind: str, offered: Mapping[str, set[str]]) -> list[str]:
    return sorted(name for name, types in offered.items() if kind in types)


def _of_its_type(names: list[str], kind: str) -> str:
    return f"{join_names(names, MAX_NAMES)} {'has' if len(names) == 1 else 'have'} its type, {kind}"


def _offer(name: str, kind: str, offered: Mapping[str, set[str]]) -> str:
    """Names what there is instead: names of the same type, else the nearest name, else all."""
    if others := _same_type(kind, offered):
        return _of_its_type(others, kind)
    near = nearest_name(name, offered)
    if near is not None:
        return f"the nearest name is {near}"
    return f"there are {join_names(sorted(offered), MAX_NAMES)}" if offered else "there are none"
