"""Shows the nodes, topics and services of the running world as a picture, with messages moving along it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Container
from textual.message import Message as ScreenMessage
from textual.timer import Timer

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.document.rows import Row, row, side_by_side
from kit.msg.conversion import FieldValue, field_values
from kit.render.graph import GraphView, draw_graph
from kit.render.graph_data import GraphData, build_graph_data
from kit.render.graph_drawing import GraphDrawing, GraphElement
from kit.render.graph_glyphs import ASCII_LINES, UNICODE_LINES
from kit.render.graph_layout import GraphLayout, arrange_graph
from kit.render.graph_selection import kept_selection, move_horizontally, move_vertically
from kit.render.message_animation import MessageAnimation
from kit.render.message_rows import message_field_rows
from kit.ros.graph.snapshot import GraphState, snapshot
from kit.ros.graph.topic_statistics import TopicStats
from kit.tui.rows.graph_rows import MARKED, GraphUpdate, about, definition_rows, heading, rates, ruled
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.dialogs import HelpDialog
from kit.tui.session_host import SessionHost
from kit.tui.theme import Theme
from kit.tui.widgets.field_plot import FieldPlot, first_field, item_count, why_not
from kit.tui.widgets.filter_field import FilteredScreen, FilterField
from kit.tui.widgets.frame_view import FrameView
from kit.tui.widgets.text_rows import RowClicked, TextRows

if TYPE_CHECKING:
    from kit.run.session import Session


class GraphListener:
    """Calls ``deliver`` with what there is to know, each time it is shown the session; in that very thread.

    Costs the world nothing before the first time, and nothing after ``stop``.
    """

    def __init__(self, deliver: Callable[[GraphUpdate], None]) -> None:
        self._deliver = deliver
        self._topic_stats: TopicStats | None = None
        self._state: GraphState | None = None
        self.chosen: str | None = None
        """The selected item; set from any thread and used the next time."""

    def __call__(self, session: Session) -> None:
        graph = session.graph
        if self._topic_stats is None or self._topic_stats.graph is not graph:
            self.stop()
            self._topic_stats = TopicStats(graph)
        self._topic_stats.select(self.chosen)
        if self._state is None or self._state.version != graph.directory.version:
            self._state = snapshot(graph)
        flow_stats, newest = self._topic_stats.flow_stats(), self._topic_stats.latest_message
        history = self._topic_stats.history()
        self._deliver(
            GraphUpdate(self._state, flow_stats, self.chosen, newest, history, session.runner.paused)
        )

    def stop(self) -> None:
        """Stops listening; may be called in the world's thread."""
        if self._topic_stats is not None:
            self._topic_stats.stop()
        self._topic_stats = self._state = None


FRAME: Final = 1 / 8
"""Seconds between two places of a dot."""

CALM: Final = 0.5
"""Seconds between two versions of anything that is read: rates, the newest message."""

ABOUT_ROWS: Final = 5
"""Of what is chosen: its name, its ends, and as much of its newest message as there is room for."""


WIDE: Final = 150
"""Columns from which the definition of a message stands beside it."""
PARTS: Final = (
    ("left", "the nodes that publish, or call"),
    ("middle", "topics with their rates, services with ()"),
    ("right", "the nodes that subscribe, or answer"),
    ("a dot", "messages on their way; an answer goes back"),
    ("a cross", "nothing arrives: quality of service does not match"),
    ("in a message", "up, down: another field; left, right: a list's item"),
)


class GraphPicture(FrameView):
    """The graph; it has as many rows as the message leaves it."""

    def on_resize(self) -> None:
        self.post_message(PictureResized())


class PictureResized(ScreenMessage):
    """The picture has another number of rows or columns."""


class GraphChanged(ScreenMessage):
    """The world's thread has heard something."""


class GraphScreen(FilteredScreen):
    """Listens while it is open. Draws only while something moves; a paused world costs no byte."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "nodes",
        ("choose", "open", "plot", "filter", "all_names", "tidy", "pause", "step", "help", "back"),
        own=(
            letter("all_names", "a", "all", "show also ROS's own topics and unused services"),
            letter("tidy", "t", "tidy", "arrange everything again"),
            letter("plot", "y", "plot", "plot the selected field of a message over time"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = f"""
    GraphScreen {{ layout: vertical; }}
    GraphScreen #heading, GraphScreen #keys {{ height: 1; }}
    GraphScreen #picture {{ height: 1fr; }}
    GraphScreen #message {{ height: {ABOUT_ROWS}; }}
    GraphScreen #about {{ width: 1fr; height: 1fr; }}
    GraphScreen.-low #message {{ height: 3; }}
    GraphScreen.-tall #message {{ height: 50%; }}
    GraphScreen.-details #picture, GraphScreen #plot {{ display: none; }}
    GraphScreen.-details #message {{ height: 1fr; }}
    GraphScreen.-details.-plot #plot {{ display: block; width: 1fr; }}
    GraphScreen.-details.-plot.-low.-narrow #about {{ height: 3; }}
    GraphScreen.-wide #message {{ layout: horizontal; }}
    GraphScreen.-wide #plot {{ margin-left: 2; }}
    """
    VERTICAL_BREAKPOINTS = [(0, "-low"), (18, "-high"), (36, "-tall")]  # noqa: RUF012 - Textual's own attribute
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (110, "-wide")]  # noqa: RUF012 - Textual's own attribute

    def __init__(self, theme: Theme, host: SessionHost, title: str) -> None:
        super().__init__()
        self.theme = theme
        self._host = host
        self._title = title
        self._rule = "-" if theme.terminal.glyphs.value == "ascii" else "─"
        self._strokes = ASCII_LINES if theme.terminal.glyphs.value == "ascii" else UNICODE_LINES
        self._picture = GraphPicture(theme.palette, id="picture")
        self._plot = FieldPlot(theme, id="plot")
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
        self._field = ""
        """The path of the field that is chosen in the message; empty until one is."""
        self._list_item = 0
        """Which item of that field is plotted, where it is a list."""
        self._about_rows = 0
        """How many rows there are to say of what is chosen, its name's among them."""
        self._everything = False
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
        with Container(id="message"):
            yield TextRows(id="about")
            yield self._plot
        yield TextRows(id="keys")
        yield FilterField()

    def on_mount(self) -> None:
        self._rows("heading").show([row((f"listening to {self._title} ...", "dim"))])
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
        """Draws all but the moving dots: the nodes, rates and texts."""
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
        talk = build_graph_data(heard.state, show_all=self._everything, name_filter=self.filter_text)
        if self._plan is None or talk != self._talk or before is None or self._plan.width != self.size.width:
            self._talk, self._places = talk, arrange_graph(talk, before)
            self._plan = GraphDrawing(talk, self._places, self.size.width)
        self._choose(kept_selection(self._plan, self._chosen, self._chosen_row))

    def _share_height(self) -> None:
        """Gives the message the rows that the graph does not need; on a tall screen half of all at least."""
        styles = self.query_one("#message").styles
        if self._plan is not None and not self.has_class("-low") and not self._shows_details:
            rest = (
                self.size.height - 3 - self._plan.layout.height
            )  # below heading, graph and an empty row; keys
            least = self.size.height // 2 if self.has_class("-tall") else ABOUT_ROWS
            styles.height = max(rest, least)
        elif styles.has_rule("height"):
            styles.clear_rule("height")
            self.refresh(layout=True)

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
        self._share_height()
        self._rows("heading").show(
            [heading(self._title, self._talk, heard, self.filter_text, self.size.width)]
        )
        width = self._rows("about").size.width or self.size.width
        full = self._shows_details or self.has_class("-tall")
        field = self._shown_field() if self._shows_details else ""
        means = self._definition(heard, width)
        column = width // 2 if means else width
        room = self._rows("about").size.height
        told = about(self._chosen, heard, column, full=full, field=field, room=room)
        head, *words = ruled(told, self._rule, width)
        words = side_by_side(words, means, column) if means else words
        self._about_rows = len(words) + 1
        room -= 1
        marked = [
            number
            for number, parts in enumerate(words)
            if field and any(style == MARKED for _, style in parts)
        ]
        if marked:  # all of it in sight, and from the first row on where that can be
            least = max(0, min(marked[0], marked[-1] - room + 1))
            self._scrolled = min(max(self._scrolled, least), marked[0])
            self._scrolled = 0 if marked[-1] < room else self._scrolled
        self._scrolled = max(0, min(self._scrolled, len(words) - room))
        self._rows("about").show((head, *words[self._scrolled :]))
        self._show_plot(field)
        self._show_keys()

    def _definition(self, heard: GraphUpdate, width: int) -> list[Row]:
        """The definition of the message's type, beside it where there is room; not beside a plot."""
        message = heard.message_of(self._chosen)
        if message is None or width < WIDE or self._shows_details or not self.has_class("-tall"):
            return []
        return definition_rows(type(message), width - width // 2)

    def _fields(self) -> list[str]:
        """The paths of the fields of the message that is shown whole."""
        message = self._heard.message_of(self._chosen) if self._heard else None
        if message is None or not self._shows_details:
            return []
        return list(dict.fromkeys(path for path, _ in message_field_rows(message, self.size.width) if path))

    def _shown_field(self) -> str:
        """The chosen field, or another while the message has no such field."""
        fields = self._fields()
        return self._field if self._field in fields else first_field(fields, self._values())

    def _values(self) -> Mapping[str, FieldValue]:
        message = self._heard.message_of(self._chosen) if self._heard else None
        return {} if message is None else field_values(message)

    def _show_plot(self, field: str) -> None:
        if self._heard is None or not self.has_class("-plot") or not self._shows_details:
            return
        values = self._values()
        reason = why_not(values, field) if field else "there is no field to plot yet"
        if reason:
            self._plot.show_reason(reason)
            return
        count = item_count(values, field)
        path = f"{field}[{min(self._list_item, count - 1)}]" if count else field
        self._plot.show(path, self._heard.history)

    def _show_keys(self) -> None:
        details = self._shows_details
        moves = "field" if self._fields() else "scroll"
        labels = {"choose": moves, "open": "close"} if details else {"open": "message"}
        keys = footer(self.screen_actions, self.size.width, without=self.unavailable_actions, labels=labels)
        self._rows("keys").show([keys])

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        """Those of the details or of the picture, whichever is not shown."""
        return ("filter", "all_names", "tidy") if self._shows_details else ("plot",)

    @property
    def _shows_details(self) -> bool:
        return self.has_class("-details")

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show_all)

    def on_picture_resized(self) -> None:
        self._choose(self._chosen)
        self._draw()

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

    def on_row_clicked(self, event: RowClicked) -> None:
        """A field of the message is chosen."""
        message = self._heard.message_of(self._chosen) if self._heard else None
        if event.rows.id != "about" or message is None or not self._shows_details:
            return
        fields = message_field_rows(message, event.rows.size.width)
        number = event.number + self._scrolled - (self._about_rows - len(fields))
        if event.number and 0 <= number < len(fields) and fields[number].path:
            self._field, self._list_item = fields[number].path, 0
            self._show_details()

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        if rows:
            self._choose_along(rows)
        else:
            self._choose_across(columns)

    def _choose_along(self, steps: int) -> None:
        fields = self._fields()
        if fields:
            number = fields.index(self._shown_field()) + steps
            self._field, self._list_item = fields[max(0, min(number, len(fields) - 1))], 0
            self._show_details()
        elif self._shows_details:
            self._scrolled += steps
            self._show_details()
        elif self._plan is not None and self._chosen is not None:
            self._move_to(move_vertically(self._plan, self._chosen, steps))

    def _choose_across(self, steps: int) -> None:
        if self._shows_details:
            last = item_count(self._values(), self._shown_field()) - 1
            self._list_item = max(0, min(self._list_item + steps, last))
            self._show_details()
        elif self._plan is not None and self._chosen is not None:
            self._move_to(move_horizontally(self._plan, self._chosen, steps))

    def _move_to(self, spot: GraphElement) -> None:
        self._choose(spot)
        self._show_details()
        self._draw()

    def action_open(self) -> None:
        self.toggle_class("-details")
        self.remove_class("-plot")
        self._share_height()
        self._scrolled = self._list_item = 0
        self._field = ""
        self.call_after_refresh(self._show_all)

    def action_plot(self) -> None:
        """Opens the message too, where it is not open."""
        if not self._shows_details:
            self.action_open()
        self.toggle_class("-plot")
        self.call_after_refresh(self._show_all)

    def on_filter(self) -> None:
        self._rearrange()

    def action_all_names(self) -> None:
        self._everything = not self._everything
        self._rearrange()

    def action_tidy(self) -> None:
        self._rearrange()

    def _rearrange(self) -> None:
        """Arranges everything as if it were opened now."""
        self._lay_out(None)
        self._share_height()
        self.call_after_refresh(self._show_all)

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
        self.app.push_screen(HelpDialog("Nodes and topics", self.screen_actions, PARTS))

    def action_back(self) -> None:
        """Leaves the innermost open view: field, plot, details, filter, and at last the screen."""
        if self.leave_field():
            return
        if self.has_class("-plot"):
            self.action_plot()
        elif self._shows_details:
            self.action_open()
        elif self.filter_text:
            self.show_all()
        else:
            self.dismiss()
