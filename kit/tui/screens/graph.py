"""Who says what to whom: the nodes, topics and services of the running world as a picture, messages on their way."""

from __future__ import annotations

import textwrap
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.message import Message as ScreenMessage
from textual.timer import Timer
from textual.widgets import Input

from kit.msg.message import Message
from kit.render.graph import (
    ASCII_LINES,
    UNICODE_LINES,
    GraphDrawing,
    GraphElement,
    GraphView,
    MessageAnimation,
    draw_graph,
    kept_selection,
    move_horizontally,
    move_vertically,
    rate_text,
)
from kit.render.graph_layout import GraphData, GraphLayout, arrange_graph, build_graph_data, message_rows
from kit.ros.graph.snapshot import (
    EndpointState,
    FlowStats,
    GraphState,
    MessageFlow,
    ServiceState,
    TopicState,
    TopicStats,
    snapshot,
)
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.dialogs import HelpDialog
from kit.tui.session_host import SessionHost
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.theme import Theme
from kit.tui.widgets.frame_view import FrameView
from kit.tui.widgets.text_rows import PLAIN, Row, TextRows, row, spread

if TYPE_CHECKING:
    from kit.run.session import Session


@dataclass(frozen=True, slots=True)
class GraphUpdate:
    """A graph at one instant. Safe to hand over."""

    state: GraphState
    flow_stats: Mapping[MessageFlow, FlowStats]
    chosen: str | None
    """The topic or service whose newest message this is."""
    newest: Message | None
    paused: bool


class GraphListener:
    """Calls ``deliver`` with what there is to know, each time it is shown the session; in that very thread.

    Costs the world nothing before the first time, and nothing after ``stop``.
    """

    def __init__(self, deliver: Callable[[GraphUpdate], None]) -> None:
        self._deliver = deliver
        self._topic_stats: TopicStats | None = None
        self._state: GraphState | None = None
        self.chosen: str | None = None
        """Set from any thread; heeded the next time."""

    def __call__(self, session: Session) -> None:
        graph = session.graph
        if self._topic_stats is None or self._topic_stats.graph is not graph:
            self.stop()
            self._topic_stats = TopicStats(graph)
        self._topic_stats.select(self.chosen)
        if self._state is None or self._state.version != graph.directory.version:
            self._state = snapshot(graph)
        flow_stats, newest = self._topic_stats.flow_stats(), self._topic_stats.latest_message
        self._deliver(GraphUpdate(self._state, flow_stats, self.chosen, newest, session.runner.paused))

    def stop(self) -> None:
        """In the world's thread too."""
        if self._topic_stats is not None:
            self._topic_stats.stop()
        self._topic_stats = self._state = None


def heading(title: str, talk: GraphData, heard: GraphUpdate, name_filter: str, width: int) -> Row:
    """Whose graph, how much of it is shown, and what is wrong in it."""
    services = sum(item.is_service for item in talk.items)
    parts = [_count(len(talk.nodes), "node"), _count(len(talk.items) - services, "topic")]
    parts += [_count(services, "service")] if services else []
    text = "  ".join(parts)
    hidden = f"  {talk.hidden_count} hidden" if talk.hidden_count else ""
    only = f"  only: {name_filter}" if name_filter else ""
    broken = sum(len(item.undelivered) for item in talk.items)
    state = row(
        (f"{_count(broken, 'broken line')} " if broken else "", "bad"),
        ("paused" if heard.paused else "", "warn"),
    )
    return spread(row((title, "bold"), f"  {text}", (hidden, "dim"), (only, "bold")), state, width)


def rates(flow_stats: Mapping[MessageFlow, FlowStats]) -> dict[str, float]:
    """Messages per second by topic and, for services, requests: by the picture's labels."""
    found: dict[str, float] = {}
    for flow, heard in flow_stats.items():
        if heard.rate is not None and flow.response_to is None:
            label = f"{flow.name}()" if flow.is_service else flow.name
            found[label] = found.get(label, 0.0) + heard.rate
    return found


def about(
    spot: GraphElement | None, heard: GraphUpdate, width: int, *, full: bool = False
) -> tuple[Row, ...]:
    """What is known of a topic, a service or a node, its name first. ``full``: all of it, however many rows."""
    if spot is None:
        return (row(("nobody is here", "dim")),)
    if spot.column != "item":
        return tuple(_of_node(spot.name, heard.state, full))
    name = spot.name.removesuffix("()")
    if name == spot.name:
        topic = next((topic for topic in heard.state.topics if topic.name == name), None)
        head = () if topic is None else tuple(_of_topic(topic, heard.flow_stats, width, full))
    else:
        service = next((service for service in heard.state.services if service.name == name), None)
        head = () if service is None else tuple(_of_service(service))
    return (*head, *_newest(heard.newest if heard.chosen == name else None, width, full))


def ruled(words: tuple[Row, ...], rule: str, width: int) -> tuple[Row, ...]:
    """The first row as a heading on a line across."""
    if not words:
        return ()
    used = sum(len(text) for text, _ in words[0])
    return (
        row((rule * 2 + " ", "dim"), *words[0], (" " + rule * max(0, width - used - 4), "dim")),
        *words[1:],
    )


def _of_topic(
    topic: TopicState, flow_stats: Mapping[MessageFlow, FlowStats], width: int, full: bool
) -> Iterator[Row]:
    yield row((topic.name, "bold"), f"  {', '.join(topic.types)}")
    for mismatch in topic.mismatches:
        for line in textwrap.wrap(f"nothing arrives: {mismatch.reason}", width):
            yield row((line, "bad"))
    if not full:
        yield row(*_ends("from", topic.publishers), *_ends("  to", topic.subscriptions))
        return
    for end in topic.publishers:
        heard = flow_stats.get(MessageFlow(end.node, topic.name))
        rate = "" if heard is None or heard.rate is None else f"  {rate_text(heard.rate)}"
        yield row(("from ", "dim"), end.node, rate, (f"  {_terms(end)}", "dim"))
    for end in topic.subscriptions:
        yield row(("to   ", "dim"), end.node, (f"  {_terms(end)}", "dim"))
    yield row()


def _of_service(service: ServiceState) -> Iterator[Row]:
    yield row((service.name, "bold"), f"  {', '.join(service.types)}")
    yield row(*_names("asked by", service.clients), *_names("  answered by", service.servers))


def _of_node(node: str, state: GraphState, full: bool) -> Iterator[Row]:
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


def _newest(message: Message | None, width: int, full: bool) -> Iterator[Row]:
    if message is None:
        yield row(("no message yet since it was chosen", "dim"))
    else:
        yield from (row(text) for text in message_rows(message, width, compact=not full))


def _is_among(node: str, ends: Sequence[EndpointState]) -> bool:
    return any(end.node == node for end in ends)


def _ends(word: str, ends: Sequence[EndpointState]) -> tuple[tuple[str, str], ...]:
    return _names(word, tuple(dict.fromkeys(end.node for end in ends)))


def _names(word: str, names: Sequence[str]) -> tuple[tuple[str, str], ...]:
    return ((f"{word} ", "dim"), (", ".join(names) or "nobody", PLAIN))


def _terms(end: EndpointState) -> str:
    """Its quality of service in a few words."""
    qos = end.qos
    kept = "keeps all" if qos.queue_length is None else f"depth {qos.queue_length}"
    return f"{qos.reliability.name} {qos.durability.name} {kept}"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


FRAME: Final = 1 / 8
"""Seconds between two places of a dot."""

CALM: Final = 0.5
"""Seconds between two versions of anything that is read: rates, the newest message."""

ABOUT_ROWS: Final = 5
"""Of what is chosen: its name, its ends, and as much of its newest message as there is room for."""


PARTS: Final = (
    ("left", "the nodes that publish, or call"),
    ("middle", "topics with their rates, services with ()"),
    ("right", "the nodes that subscribe, or answer"),
    ("a dot", "messages on their way; an answer goes back"),
    ("a cross", "nothing arrives: quality of service does not match"),
)


class GraphChanged(ScreenMessage):
    """The world's thread has heard something."""


class GraphScreen(ActivePaintScreen[None]):
    """Listens while it is open. Draws only while something moves; a paused world costs no byte."""

    AUTO_FOCUS = ""
    BINDINGS: ClassVar[list[BindingType]] = bindings("nodes")
    DEFAULT_CSS = f"""
    GraphScreen {{ layout: vertical; }}
    GraphScreen #heading, GraphScreen #keys {{ height: 1; }}
    GraphScreen FrameView {{ height: 1fr; }}
    GraphScreen #about {{ height: {ABOUT_ROWS}; }}
    GraphScreen Input, GraphScreen Input:focus {{ border: none; padding: 0; height: 1; background: transparent; }}
    GraphScreen.-low #about {{ height: 3; }}
    GraphScreen.-tall #about {{ height: 50%; }}
    GraphScreen.-details FrameView {{ display: none; }}
    GraphScreen.-details #about {{ height: 1fr; }}
    """
    VERTICAL_BREAKPOINTS = [(0, "-low"), (18, "-high"), (36, "-tall")]  # noqa: RUF012 - Textual's own attribute

    def __init__(self, theme: Theme, host: SessionHost, title: str) -> None:
        super().__init__()
        self.theme = theme
        self._host = host
        self._title = title
        self._rule = "-" if theme.terminal.glyphs.value == "ascii" else "─"
        self._strokes = ASCII_LINES if theme.terminal.glyphs.value == "ascii" else UNICODE_LINES
        self._picture = FrameView(theme.palette)
        self._listener = GraphListener(self._on_graph_update)
        self._announced = False
        self._heard: GraphUpdate | None = None
        self._talk = GraphData((), ())
        self._places: GraphLayout | None = None
        self._plan: GraphDrawing | None = None
        self._travel = MessageAnimation()
        self._rates: Mapping[str, float] = {}
        self._chosen: GraphElement | None = None
        self._chosen_row = self._top = self._scrolled = 0
        self._everything = False
        self._narrowed = ""
        self._clock: Timer | None = None
        self._read = 0.0
        """When what is read was last made again."""
        self._is_stale = False
        """Whether there is something newer to read."""

    @property
    def is_moving(self) -> bool:
        """Whether a dot is under way, or something waits to be read."""
        return self._clock is not None

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield self._picture
        yield TextRows(id="about")
        yield TextRows(id="keys")
        yield Input(
            placeholder="part of a name; Enter keeps the filter, Esc shows all", select_on_focus=False
        )

    def on_mount(self) -> None:
        self._rows("heading").show([row((f"listening to {self._title} ...", "dim"))])
        self.query_one(Input).cursor_blink = False
        self._ask_for_name(False)
        self._host.set_listener(self._listener)

    def on_unmount(self) -> None:
        self._host.set_listener(None)
        self._host.post(lambda session: self._listener.stop())

    # What arrives from the world's thread

    def _on_graph_update(self, heard: GraphUpdate) -> None:
        self._heard = heard
        if not self._announced:  # the newest wins
            self._announced = True
            self.post_message(GraphChanged())

    def on_graph_changed(self) -> None:
        self._announced = False
        heard = self._heard
        if heard is not None and self.is_active:
            self._travel.update_counts(heard.flow_stats)
            self._is_stale = True
            if self._clock is None:
                self._frame()

    def _frame(self) -> None:
        """Moves the dots on, and comes back as long as there is anything to move or to read."""
        self._clock = None
        self._travel.advance(self._talk)
        if self._is_stale and time.monotonic() - self._read >= CALM:
            self._refresh_text()
        self._draw()
        if self._travel.is_active or self._is_stale:
            self._clock = self.set_timer(FRAME, self._frame)

    # What is shown

    def _refresh_text(self) -> None:
        """Everything but the dots: who is there, rates, words."""
        heard = self._heard
        if heard is None:
            return
        self._read, self._is_stale = time.monotonic(), False
        self._rates = rates(heard.flow_stats)
        self._lay_out(self._places)
        self._show_details()

    def _lay_out(self, before: GraphLayout | None) -> None:
        """Places for all that is to be seen; with the places before, nothing jumps."""
        heard = self._heard
        if heard is None or not self.size.width:
            return
        talk = build_graph_data(heard.state, show_all=self._everything, name_filter=self._narrowed)
        if self._plan is None or talk != self._talk or before is None or self._plan.width != self.size.width:
            self._talk, self._places = talk, arrange_graph(talk, before)
            self._plan = GraphDrawing(talk, self._places, self.size.width)
        self._choose(kept_selection(self._plan, self._chosen, self._chosen_row))

    def _choose(self, spot: GraphElement | None) -> None:
        if spot != self._chosen:
            self._scrolled = 0
        self._chosen = spot
        self._listener.chosen = spot.name.removesuffix("()") if spot and spot.column == "item" else None
        if spot is not None and self._plan is not None:
            self._chosen_row = self._plan.element_rows()[spot]
            rows = max(1, self._picture.size.height)
            self._top = min(max(self._top, self._chosen_row - rows + 1), self._chosen_row)
            self._top = max(0, min(self._top, self._plan.layout.height - rows))

    def _draw(self) -> None:
        rows = self._picture.size.height
        if self._plan is not None and rows:
            sight = GraphView(self._rates, self._chosen, self._travel.cells(self._plan), self._top)
            self._picture.show_frame(draw_graph(self._plan, sight, rows, self._strokes))

    def _show_details(self) -> None:
        heard = self._heard
        if heard is None:
            return
        width = self.size.width
        self._rows("heading").show([heading(self._title, self._talk, heard, self._narrowed, width)])
        head, *words = ruled(
            about(self._chosen, heard, width, full=self._shows_details or self.has_class("-tall")),
            self._rule,
            width,
        )
        room = self._rows("about").size.height - 1
        self._scrolled = max(0, min(self._scrolled, len(words) - room))
        self._rows("about").show((head, *words[self._scrolled :]))
        self._show_keys()

    def _show_keys(self) -> None:
        details = self._shows_details
        labels = {"choose": "scroll", "open": "close"} if details else {"open": "message"}
        without = ("filter", "all_names", "tidy") if details else ()
        self._rows("keys").show([footer("nodes", self.size.width, without=without, labels=labels)])

    @property
    def _shows_details(self) -> bool:
        return self.has_class("-details")

    def _rows(self, name: str) -> TextRows:
        return self.query_one(f"#{name}", TextRows)

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show_all)

    def _show_all(self) -> None:
        self._show_keys()
        self._lay_out(self._places)
        self._show_details()
        self._draw()

    # The mouse

    def on_click(self, event: events.Click) -> None:
        """A node, topic or service is chosen."""
        column, row_number = event.screen_offset - self._picture.region.offset
        if self._plan is None or not self._picture.region.contains_point(event.screen_offset):
            return
        columns = self._plan.columns
        name = (
            "sender"
            if column < columns.item_start
            else "item"
            if column < columns.receiver_start
            else "receiver"
        )
        rows = self._plan.element_rows()
        found = [each for each in rows if each.column == name and rows[each] == row_number + self._top]
        if found:
            self._choose(found[0])
            self._show_details()
            self._draw()

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        if rows:
            self._choose_along(rows)
        else:
            self._choose_across(columns)

    def _choose_along(self, steps: int) -> None:
        if self._shows_details:
            self._scrolled += steps
            self._show_details()
        elif self._plan is not None and self._chosen is not None:
            self._move_to(move_vertically(self._plan, self._chosen, steps))

    def _choose_across(self, steps: int) -> None:
        if not self._shows_details and self._plan is not None and self._chosen is not None:
            self._move_to(move_horizontally(self._plan, self._chosen, steps))

    def _move_to(self, spot: GraphElement) -> None:
        self._choose(spot)
        self._show_details()
        self._draw()

    def action_open(self) -> None:
        self.toggle_class("-details")
        self._scrolled = 0
        self.call_after_refresh(self._show_all)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        # Before all others, so that letters that come with it reach the field; in the field it is a letter itself.
        return action != "filter" or (self.is_mounted and self.focused is None)

    def action_filter(self) -> None:
        self._ask_for_name(True)

    def on_input_changed(self, event: Input.Changed) -> None:
        self._narrowed = event.value
        self._rearrange()

    def on_input_submitted(self) -> None:
        self._ask_for_name(False)

    def _ask_for_name(self, asked: bool) -> None:
        """The field in place of the keys, or the keys. At once: the next letters may be here already."""
        field = self.query_one(Input)
        field.display, self._rows("keys").display = asked, not asked
        self.set_focus(field if asked else None)

    def action_all_names(self) -> None:
        self._everything = not self._everything
        self._rearrange()

    def action_tidy(self) -> None:
        self._rearrange()

    def _rearrange(self) -> None:
        """Arranges everything as if it were opened now."""
        self._lay_out(None)
        self._show_details()
        self._draw()

    def action_pause(self) -> None:
        self._host.set_paused(not self._is_paused)

    def action_step(self) -> None:
        if self._is_paused:
            self._host.step()
        else:
            self._host.set_paused(True)

    @property
    def _is_paused(self) -> bool:
        return self._heard is not None and self._heard.paused

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Nodes and topics", "nodes", PARTS))

    def action_back(self) -> None:
        """One thing at a time: out of the field, the details, the narrowing, the screen."""
        if self.focused is not None:
            self.query_one(Input).value = ""
            self._ask_for_name(False)
        elif self._shows_details:
            self.action_open()
        elif self._narrowed:
            self.query_one(Input).value = ""
        else:
            self.dismiss()
