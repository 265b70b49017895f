"""The data of a graph drawing: topics and services with their senders and receivers, filtered.

A message as text, as ``ros2 topic echo`` writes it: YAML, short enough to be looked at.
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from kit.msg.conversion import to_dict
from kit.msg.message import Message
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


INDENT: Final = "  "
MAX_NUMBER_ROWS: Final = 4

_PLAIN: Final = re.compile(r"[^\W\d_][\w ./-]*")
_RESERVED_WORDS: Final = frozenset({"true", "false", "yes", "no", "on", "off", "null", "y", "n"})
"""Words that YAML does not read as text."""


def message_rows(message: Message, width: int, *, compact: bool = False) -> list[str]:
    """Rows of at most ``width`` characters. ``compact``: what fits on one row stands on one, in braces.

    Long lists of numbers are cut off after a few rows, with their length.
    """
    return [row[:width] for row in _field_rows(to_dict(message), width, "", compact)]


def _field_rows(data: Mapping[str, Any], width: int, indent: str, compact: bool) -> Iterator[str]:
    if not data:
        yield f"{indent}{{}}"
    for name, value in data.items():
        yield from _value_rows(f"{indent}{name}:", value, width, indent, compact)


def _value_rows(head: str, value: Any, width: int, indent: str, compact: bool) -> Iterator[str]:
    if isinstance(value, Mapping):
        line = f"{head} {_inline(value)}"
        if compact and len(line) <= width:
            yield line
        else:
            yield head
            yield from _field_rows(value, width, indent + INDENT, compact)
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        yield head
        for entry in value:
            first, *rest = _field_rows(entry, width, indent + INDENT, compact)
            yield f"{indent}- {first.lstrip()}"
            yield from rest
    elif isinstance(value, list):
        yield from _numbers(head, value, width, indent)
    else:
        yield f"{head} {_scalar(value)}"


def _numbers(head: str, values: list[Any], width: int, indent: str) -> Iterator[str]:
    text = f"{head} {_inline(values)}"
    rows = textwrap.wrap(text, width, subsequent_indent=indent + INDENT) or [text]
    if len(rows) > MAX_NUMBER_ROWS:
        note = f" ... {len(values)} in all]"
        rows = rows[:MAX_NUMBER_ROWS]
        rows[-1] = rows[-1][: width - len(note)].rpartition(",")[0] + "," + note
    yield from rows


def _inline(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{name}: {_inline(entry)}' for name, entry in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(_inline(entry) for entry in value)}]"
    return _scalar(value)


def _scalar(value: Any) -> str:
    """A number or a text as YAML has it; a float in no more than six digits after the point."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return _float(value)
    return _text(value) if isinstance(value, str) else str(value)


def _float(value: float) -> str:
    if value != value or value in (float("inf"), float("-inf")):
        return ".nan" if value != value else ".inf" if value > 0 else "-.inf"
    short = repr(round(value, 6))
    return short if float(short) or not value else repr(value)


def _text(value: str) -> str:
    """In quotes unless it can be taken for nothing but a text."""
    if _PLAIN.fullmatch(value) and value.lower() not in _RESERVED_WORDS:
        return value
    return json.dumps(value, ensure_ascii=False) if value else "''"
