"""Who talks with whom, as a picture needs it: topics and services with their senders and receivers, and no more
of them than somebody wants to see."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from kit.ros.graph.snapshot import GraphState, ServiceState, TopicState


@dataclass(frozen=True, slots=True)
class Item:
    """A topic, from publishers to subscriptions, or a service, from clients to servers."""

    label: str
    """Its name; a service's ends with ``()``, so that no two items have the same."""
    name: str
    senders: tuple[str, ...]
    receivers: tuple[str, ...]
    """Full names of nodes."""
    broken: frozenset[tuple[str, str]] = frozenset()
    """Sender and receiver between whom nothing is delivered."""

    @property
    def is_service(self) -> bool:
        return self.label != self.name


@dataclass(frozen=True, slots=True)
class Conversation:
    """What is to be drawn, and how much is left out."""

    nodes: tuple[str, ...]
    items: tuple[Item, ...]
    hidden: int = 0
    """Topics and services left out as plumbing, or because nobody uses them; not those that were narrowed away."""

    def sent_by(self, node: str) -> tuple[Item, ...]:
        return tuple(item for item in self.items if node in item.senders)

    def received_by(self, node: str) -> tuple[Item, ...]:
        return tuple(item for item in self.items if node in item.receivers)


def conversation(state: GraphState, *, everything: bool = False, narrowed: str = "") -> Conversation:
    """What there is to see of a graph. ``everything``: also what ROS needs for itself (parameter services,
    ``/rosout``, ``/tf``) and services that nobody asks. ``narrowed``: only what has this text in its name, and
    whatever is joined to that."""
    items = [_topic_item(topic) for topic in state.topics if everything or not topic.is_infrastructure]
    items += [_service_item(service) for service in state.services if everything or _is_used(service)]
    hidden = len(state.topics) + len(state.services) - len(items)
    wanted = narrowed.casefold()
    shown = tuple(item for item in items if any(wanted in name.casefold() for name in _names(item)))
    joined = {node for item in shown for node in (*item.senders, *item.receivers)}
    nodes = tuple(node for node in state.nodes if node in joined or wanted in node.casefold())
    return Conversation(nodes, shown, hidden)


def _is_used(service: ServiceState) -> bool:
    return bool(service.clients) and not service.is_infrastructure


def _names(item: Item) -> Iterator[str]:
    yield item.label
    yield from item.senders
    yield from item.receivers


def _topic_item(topic: TopicState) -> Item:
    return Item(
        topic.name,
        topic.name,
        tuple(dict.fromkeys(end.node for end in topic.publishers)),
        tuple(dict.fromkeys(end.node for end in topic.subscriptions)),
        frozenset((mismatch.publisher, mismatch.subscription) for mismatch in topic.mismatches),
    )


def _service_item(service: ServiceState) -> Item:
    return Item(f"{service.name}()", service.name, service.clients, service.servers)
