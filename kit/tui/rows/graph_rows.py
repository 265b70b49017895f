"""The screen of nodes and topics as rows of text: its heading, and the details of what is selected."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

from kit.document.rows import PLAIN, Row, at_both_edges, broken, row
from kit.inspection.definition_text import CommentOptions, definition_text
from kit.msg.definition_parser import DefinitionError
from kit.msg.message import Message
from kit.plain_text import counted, wrap
from kit.render.graph import rate_text
from kit.render.graph_data import GraphData
from kit.render.graph_drawing import GraphElement
from kit.render.message_rows import message_field_rows
from kit.ros.graph.snapshot import EndpointState, GraphState, ServiceState, TopicState
from kit.ros.graph.topic_statistics import FieldSample, FlowStats, MessageFlow

INDENT: Final = 2
"""Columns by which the fields of a field are indented."""
FOLDS: Final = (40, 60, 80)
"""Columns to which a message may be folded where that gives rows enough for all of it."""
MARKED: Final = "key"
"""The style of the field that is chosen in a message."""


@dataclass(frozen=True, slots=True)
class GraphUpdate:
    """A graph at one instant. Safe to hand over."""

    state: GraphState
    flow_stats: Mapping[MessageFlow, FlowStats]
    chosen: str | None
    """The topic or service whose newest message this is."""
    newest: Message | None
    history: tuple[FieldSample, ...]
    """Samples of the last messages of that topic or service, oldest first."""
    paused: bool

    def message_of(self, spot: GraphElement | None) -> Message | None:
        """The newest message of a topic or service, if it is the chosen one."""
        is_chosen = spot is not None and spot.column == "item" and spot.name.removesuffix("()") == self.chosen
        return self.newest if is_chosen else None


def heading(title: str, talk: GraphData, heard: GraphUpdate, name_filter: str, width: int) -> Row:
    """Returns the graph's title, how much of it is shown, and what is wrong in it."""
    services = sum(item.is_service for item in talk.items)
    parts = [counted(len(talk.nodes), "node"), counted(len(talk.items) - services, "topic")]
    parts += [counted(services, "service")] if services else []
    text = "  ".join(parts)
    hidden = f"  {talk.hidden_count} not shown" if talk.hidden_count else ""
    only = f"  only: {name_filter}" if name_filter else ""
    broken = sum(len(item.undelivered) for item in talk.items)
    state = row(
        (f"{counted(broken, 'broken line')} " if broken else "", "bad"),
        ("paused" if heard.paused else "", "warn"),
    )
    return at_both_edges(row((title, "title"), f"  {text}", (hidden, "dim"), (only, "bold")), state, width)


def rates(flow_stats: Mapping[MessageFlow, FlowStats]) -> dict[str, float]:
    """Messages per second by topic and, for services, requests: by the picture's labels."""
    found: dict[str, float] = {}
    for flow, heard in flow_stats.items():
        if heard.rate is not None and flow.response_to is None:
            label = f"{flow.name}()" if flow.is_service else flow.name
            found[label] = found.get(label, 0.0) + heard.rate
    return found


def about(
    spot: GraphElement | None,
    heard: GraphUpdate,
    width: int,
    *,
    full: bool = False,
    field: str = "",
    room: int = 0,
) -> tuple[Row, ...]:
    """What is known of a topic, a service or a node, its name first. ``full``: all of it, however many rows; else a message is
    folded as little as ``room`` rows allow.
    ``field``: the one that is marked in the message."""
    if spot is None:
        return (row(("no nodes", "dim")),)
    if spot.column != "item":
        return tuple(_node_rows(spot.name, heard.state, full))
    name = spot.name.removesuffix("()")
    if name == spot.name:
        topic = next((topic for topic in heard.state.topics if topic.name == name), None)
        head = () if topic is None else tuple(_topic_rows(topic, heard.flow_stats, width, full))
    else:
        service = next((service for service in heard.state.services if service.name == name), None)
        head = () if service is None else tuple(_service_rows(service))
    return (*head, *_newest_message_rows(heard.message_of(spot), width, full, field, room - len(head)))


@cache
def definition_rows(cls: type[Message], width: int) -> list[Row]:
    """The definition of a type with what its comments say of its fields; none of a type that nobody has written down."""
    try:
        text = definition_text(cls, CommentOptions(nested=True))
    except (DefinitionError, LookupError, OSError):
        return []
    rows: list[Row] = []
    for line in filter(str.strip, text.splitlines()):
        field, sign, comment = line.expandtabs(INDENT).partition("#")
        rows += broken(row(field, (f"{sign}{comment}", "dim")), width)
    return rows


def ruled(words: tuple[Row, ...], rule: str, width: int) -> tuple[Row, ...]:
    """The first row as a heading on a line across."""
    if not words:
        return ()
    used = sum(len(text) for text, _ in words[0])
    return (
        row((rule * 2 + " ", "dim"), *words[0], (" " + rule * max(0, width - used - 4), "dim")),
        *words[1:],
    )


def _topic_rows(
    topic: TopicState, flow_stats: Mapping[MessageFlow, FlowStats], width: int, full: bool
) -> Iterator[Row]:
    yield row((topic.name, "bold"), f"  {', '.join(topic.types)}")
    for mismatch in topic.mismatches:
        for line in wrap(f"nothing arrives: {mismatch.reason}", width):
            yield row((line, "bad"))
    if not full:
        yield row(*_endpoint_names("from", topic.publishers), *_endpoint_names("  to", topic.subscriptions))
        return
    for end in topic.publishers:
        heard = flow_stats.get(MessageFlow(end.node, topic.name))
        rate = "" if heard is None or heard.rate is None else f"  {rate_text(heard.rate)}"
        yield row(("from ", "dim"), end.node, rate, (f"  {_qos_text(end)}", "dim"))
    for end in topic.subscriptions:
        yield row(("to   ", "dim"), end.node, (f"  {_qos_text(end)}", "dim"))
    if not topic.subscriptions:
        yield row(*_endpoint_names("to  ", ()))
    yield row()


def _service_rows(service: ServiceState) -> Iterator[Row]:
    yield row((service.name, "bold"), f"  {', '.join(service.types)}")
    yield row(*_node_names("asked by", service.clients), *_node_names("  answered by", service.servers))


def _node_rows(node: str, state: GraphState, full: bool) -> Iterator[Row]:
    topics = [topic for topic in state.topics if full or not topic.is_infrastructure]
    services = [service for service in state.services if full or not service.is_infrastructure]
    lists = (
        ("publishes", [topic.name for topic in topics if _is_among(node, topic.publishers)]),
        ("subscribes", [topic.name for topic in topics if _is_among(node, topic.subscriptions)]),
        ("asks", [service.name for service in services if node in service.clients]),
        ("answers", [service.name for service in services if node in service.servers]),
    )
    yield row((node, "bold"), "  node")
    for word, names in lists:
        if full:
            yield from (
                row((f"{word if place == 0 else '':<12}", "dim"), name) for place, name in enumerate(names)
            )
        elif names:
            yield row((f"{word:<12}", "dim"), ", ".join(names))


def _newest_message_rows(
    message: Message | None, width: int, full: bool, field: str, room: int
) -> Iterator[Row]:
    if message is None:
        yield row(("no message yet since it was chosen", "dim"))
        return
    for fold in (width,) if full else (*(each for each in FOLDS if each < width), width):
        rows = message_field_rows(message, fold, compact=not full)
        if len(rows) <= room:
            break
    for path, text in rows:
        yield row((text, MARKED if field and path == field else PLAIN))


def _is_among(node: str, ends: Sequence[EndpointState]) -> bool:
    return any(end.node == node for end in ends)


def _endpoint_names(word: str, ends: Sequence[EndpointState]) -> tuple[tuple[str, str], ...]:
    return _node_names(word, tuple(dict.fromkeys(end.node for end in ends)))


def _node_names(word: str, names: Sequence[str]) -> tuple[tuple[str, str], ...]:
    return ((f"{word} ", "dim"), (", ".join(names) or "no node", PLAIN))


def _qos_text(end: EndpointState) -> str:
    """Its quality of service in a few words."""
    qos = end.qos
    kept = "keeps all" if qos.queue_length is None else f"depth {qos.queue_length}"
    return f"{qos.reliability.name} {qos.durability.name} {kept}"
