"""What a graph drawing shows: nodes, topics and services, without what is hidden or not asked for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from kit.ros.graph.snapshot import GraphState, ServiceState, TopicState


@dataclass(frozen=True, slots=True)
class GraphItem:
    """A topic, from publishers to subscriptions, or a service, from clients to servers."""

    label: str
    """Its name; a service's ends with ``()``, so that no two items have the same."""
    name: str
    senders: tuple[str, ...]
    receivers: tuple[str, ...]
    """Full names of nodes."""
    undelivered: frozenset[tuple[str, str]] = frozenset()
    """Sender and receiver between whom nothing is delivered."""

    @property
    def is_service(self) -> bool:
        return self.label != self.name


@dataclass(frozen=True, slots=True)
class GraphData:
    """Nodes and items to draw, and the number left out."""

    nodes: tuple[str, ...]
    items: tuple[GraphItem, ...]
    hidden_count: int = 0
    """Topics and services left out as plumbing, or because they are unused; not those that the filter removed."""

    def items_sent_by(self, node: str) -> tuple[GraphItem, ...]:
        return tuple(item for item in self.items if node in item.senders)

    def items_received_by(self, node: str) -> tuple[GraphItem, ...]:
        return tuple(item for item in self.items if node in item.receivers)


def build_graph_data(state: GraphState, *, show_all: bool = False, name_filter: str = "") -> GraphData:
    """Collects the nodes and items to draw. ``show_all``: also ROS's own (parameter services,
    ``/rosout``, ``/tf``) and services without clients. ``name_filter``: only what has this text in its name, and
    whatever is joined to that."""
    items = [_topic_item(topic) for topic in state.topics if show_all or not topic.is_infrastructure]
    items += [_service_item(service) for service in state.services if show_all or _is_used(service)]
    hidden = len(state.topics) + len(state.services) - len(items)
    needle = name_filter.casefold()
    shown = tuple(item for item in items if any(needle in name.casefold() for name in _names(item)))
    linked_nodes = {node for item in shown for node in (*item.senders, *item.receivers)}
    nodes = tuple(node for node in state.nodes if node in linked_nodes or needle in node.casefold())
    return GraphData(nodes, shown, hidden)


def _is_used(service: ServiceState) -> bool:
    return bool(service.clients) and not service.is_infrastructure


def _names(item: GraphItem) -> Iterator[str]:
    yield item.label
    yield from item.senders
    yield from item.receivers


def _topic_item(topic: TopicState) -> GraphItem:
    return GraphItem(
        topic.name,
        topic.name,
        tuple(dict.fromkeys(end.node for end in topic.publishers)),
        tuple(dict.fromkeys(end.node for end in topic.subscriptions)),
        frozenset((mismatch.publisher, mismatch.subscription) for mismatch in topic.mismatches),
    )


def _service_item(service: ServiceState) -> GraphItem:
    return GraphItem(f"{service.name}()", service.name, service.clients, service.servers)
