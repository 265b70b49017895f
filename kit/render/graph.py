"""The ROS graph in characters: nodes left and right, topics and services between them, lines and what moves on them.

Two lines that cross do not touch: the level one is drawn through. They touch where a corner or a tee is drawn.
The selected element stands in brackets, and its lines are thick; a service's lines are dashed. So no meaning hangs on
colour.

Animates messages in a graph drawing: a few dots, each at the same slow pace.

A dot stands for all messages on a line since the last dot left, so that ten messages a second and a thousand
look alike: traffic, not a flicker.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Final, Literal, NamedTuple

import numpy as np

from kit.render.encode import Frame
from kit.render.graph_layout import GraphData, GraphItem, GraphLayout
from kit.render.roles import Role
from kit.ros.graph.snapshot import FlowStats, MessageFlow

ColumnName = Literal["sender", "item", "receiver"]

LINE_ROLE: Final = Role.WALL
NAME_ROLE: Final = Role.WALL
SELECTED_ROLE: Final = Role.ROBOT
MESSAGE_ROLE: Final = Role.HIT
MISMATCH_ROLE: Final = Role.CONTACT
RATE_ROLE: Final = Role.TRAIL
"""Roles of the world's palette as used for the graph."""


class GraphElement(NamedTuple):
    """A node or an item of the picture. A node that sends and receives is drawn twice."""

    column: ColumnName
    name: str
    """The node's full name or the item's label."""


class GraphLink(NamedTuple):
    """A node's line to an item, or an item's to a node."""

    node: str
    item: str
    """Its label."""
    is_sender: bool
    """Whether it leads from the node to the item; else from the item to the node."""


class GraphCell(NamedTuple):
    column: int
    row: int


@dataclass(frozen=True, slots=True)
class ColumnLayout:
    """Positions and widths of the columns."""

    width: int
    node_width: int
    """Width of each column of nodes."""
    left_gap: int
    """Between senders and items: lanes, then the rate, then the arrow."""
    item_width: int
    right_gap: int
    """Between items and receivers: lanes, then the arrow."""
    lane_pitch: tuple[int, int]
    """Characters from one lane to the next, left and right."""

    @property
    def item_start(self) -> int:
        """The first character of the items."""
        return self.node_width + self.left_gap

    @property
    def receiver_start(self) -> int:
        """The first character of the receivers."""
        return self.item_start + self.item_width + self.right_gap


RATE_WIDTH: Final = 8
ARROW_WIDTH: Final = 2
MIN_LANE_WIDTHS: Final = (5, 8)
"""Characters kept for lanes, left and right, so that the columns stay where they are when one joins."""
MIN_NAME_WIDTH: Final = 8


def fit_columns(width: int, layout: GraphLayout) -> ColumnLayout:
    """The columns for a picture of this width: what lanes need beyond the usual is taken from the names."""
    needed = [max(side.lanes.values(), default=-1) + 1 for side in (layout.senders, layout.receivers)]
    left, right = (max(least, lanes) for least, lanes in zip(MIN_LANE_WIDTHS, needed, strict=True))
    names = max(3 * MIN_NAME_WIDTH, width - left - right - RATE_WIDTH - 2 * ARROW_WIDTH)
    nodes = names // 3
    pitches = tuple(
        2 if lanes and 2 * lanes <= room else 1 for lanes, room in zip(needed, (left, right), strict=True)
    )
    return ColumnLayout(
        width,
        nodes,
        left + RATE_WIDTH + ARROW_WIDTH,
        names - 2 * nodes,
        right + ARROW_WIDTH,
        (pitches[0], pitches[1]),
    )


EAST, NORTH, WEST, SOUTH = 1, 2, 4, 8
HORIZONTAL, VERTICAL = EAST | WEST, NORTH | SOUTH


@dataclass(frozen=True, slots=True)
class LineGlyphs:
    """The characters of lines, by where they lead; and the other signs."""

    light: Mapping[int, str]
    heavy: Mapping[int, str]
    dashed: Mapping[int, str]
    arrow: str
    message: str
    mismatch: str
    ellipsis: str
    """Stands for the beginning of a name that is too long."""


def _line_table(level: str, upright: str, corners: str) -> Mapping[int, str]:
    joints = (EAST | SOUTH, WEST | SOUTH, NORTH | EAST, NORTH | WEST, VERTICAL | EAST, VERTICAL | WEST)
    tees = (*joints, HORIZONTAL | SOUTH, HORIZONTAL | NORTH, HORIZONTAL | VERTICAL)
    straight = {
        EAST: level,
        WEST: level,
        HORIZONTAL: level,
        NORTH: upright,
        SOUTH: upright,
        VERTICAL: upright,
    }
    return MappingProxyType({**straight, **dict(zip(tees, corners, strict=True))})


_LIGHT = "┌┐└┘├┤┬┴┼"
UNICODE_LINES: Final = LineGlyphs(
    _line_table("─", "│", _LIGHT),
    _line_table("━", "┃", "┏┓┗┛┣┫┳┻╋"),
    _line_table("╌", "│", _LIGHT),
    arrow="▶",
    message="●",
    mismatch="✗",
    ellipsis="…",
)
ASCII_LINES: Final = LineGlyphs(
    _line_table("-", "|", "+" * 9),
    _line_table("=", "|", "#" * 9),
    _line_table(".", "|", "+" * 9),
    arrow=">",
    message="o",
    mismatch="X",
    ellipsis="~",
)


@dataclass(frozen=True, slots=True)
class _LinkRoute:
    """A link's cells from the sender to the receiver, and where they lead."""

    cells: tuple[tuple[GraphCell, int], ...]
    branch_cell: GraphCell
    """The cell where the node's lane meets the item's row; the middle of a straight line."""


@dataclass(frozen=True)
class GraphDrawing:
    """The cells of every node, item and link of a graph, in a picture of this width."""

    graph: GraphData
    layout: GraphLayout
    width: int

    @cached_property
    def columns(self) -> ColumnLayout:
        return fit_columns(self.width, self.layout)

    @cached_property
    def routes(self) -> Mapping[GraphLink, _LinkRoute]:
        routes: dict[GraphLink, _LinkRoute] = {}
        for item in self.graph.items:
            for node in item.senders:
                routes[GraphLink(node, item.label, is_sender=True)] = self._sender_route(node, item)
            for node in item.receivers:
                routes[GraphLink(node, item.label, is_sender=False)] = self._receiver_route(node, item)
        return routes

    def link_cells(self, link: GraphLink) -> tuple[GraphCell, ...]:
        """The characters that a message on this link goes through, from sender to receiver."""
        return tuple(cell for cell, _ in self.routes[link].cells)

    def links_of(self, element: GraphElement | None) -> Collection[GraphLink]:
        """Returns the links of the selected element: a node's on both its sides."""
        if element is None:
            return ()
        return {
            link
            for link in self.routes
            if element.name == (link.item if element.column == "item" else link.node)
        }

    def element_rows(self) -> Mapping[GraphElement, int]:
        """Returns every element that can be selected, with its row."""
        rows = {GraphElement("sender", node): row for node, row in self.layout.senders.rows.items()}
        rows |= {GraphElement("item", label): row for label, row in self.layout.items.items()}
        return rows | {
            GraphElement("receiver", node): row for node, row in self.layout.receivers.rows.items()
        }

    def _sender_route(self, node: str, item: GraphItem) -> _LinkRoute:
        columns, node_row, row = self.columns, self.layout.senders.rows[node], self.layout.items[item.label]
        start, end = min(len(node), columns.node_width - 2) + 2, columns.item_start - 1
        lane = self.layout.senders.lanes.get(node)
        lane_column = None if lane is None else columns.node_width + lane * columns.lane_pitch[0]
        return _route(start, end, lane_column, node_row, row)

    def _receiver_route(self, node: str, item: GraphItem) -> _LinkRoute:
        columns, node_row, row = self.columns, self.layout.receivers.rows[node], self.layout.items[item.label]
        start = columns.item_start + min(len(item.label), columns.item_width - 2) + 2
        end = columns.receiver_start - 1
        lane = self.layout.receivers.lanes.get(node)
        lane_column = (
            None if lane is None else columns.receiver_start - ARROW_WIDTH - 1 - lane * columns.lane_pitch[1]
        )
        return _route(start, end, lane_column, row, node_row)


def _route(start: int, end: int, lane: int | None, first: int, last: int) -> _LinkRoute:
    """A way along row ``first`` to the lane, along that, and on row ``last`` to the end (exclusive)."""
    if lane is None:
        cells = [(GraphCell(column, first), HORIZONTAL) for column in range(start, end)]
        return _LinkRoute(tuple(cells), cells[len(cells) // 2][0])
    cells = [(GraphCell(column, first), HORIZONTAL) for column in range(start, lane)]
    if first == last:
        cells.append((GraphCell(lane, first), HORIZONTAL))
    else:
        down = last > first
        onward, back = (SOUTH, NORTH) if down else (NORTH, SOUTH)
        cells.append((GraphCell(lane, first), WEST | onward))
        cells += [
            (GraphCell(lane, row), VERTICAL)
            for row in range(first + (1 if down else -1), last, 1 if down else -1)
        ]
        cells.append((GraphCell(lane, last), back | EAST))
    cells += [(GraphCell(column, last), HORIZONTAL) for column in range(lane + 1, end)]
    return _LinkRoute(tuple(cells), GraphCell(lane, first))


@dataclass(frozen=True, slots=True)
class GraphView:
    """Rates, selection and messages to show, and the first visible row."""

    rates: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    """Messages per second, by an item's label."""
    selected: GraphElement | None = None
    message_cells: Collection[GraphCell] = ()
    """Cells that show a moving message."""
    first_row: int = 0
    """The first row shown."""


def draw_graph(
    drawing: GraphDrawing, view: GraphView, rows: int, glyphs: LineGlyphs = UNICODE_LINES
) -> Frame:
    """The picture, ``drawing.width`` x ``rows`` characters."""
    painter = _GraphPainter(drawing, view, rows, glyphs)
    painter.draw_lines()
    painter.draw_mismatches()
    painter.draw_rates()
    painter.draw_messages()
    painter.draw_names()
    return painter.frame


def rate_text(rate: float) -> str:
    """Formats a rate in up to seven characters: ``0.5 Hz``, ``10 Hz``, ``1.2 kHz``."""
    if rate >= 1000:
        return f"{rate / 1000:.2g} kHz"
    return f"{rate:.0f} Hz" if rate >= 9.5 else f"{rate:.2g} Hz"


class _GraphPainter:
    def __init__(self, drawing: GraphDrawing, view: GraphView, rows: int, glyphs: LineGlyphs) -> None:
        self._drawing, self._view, self._glyphs = drawing, view, glyphs
        self._selected_links = drawing.links_of(view.selected)
        self.frame = Frame.empty(drawing.width, rows)
        self._text_cells: set[GraphCell] = set()

    def draw_lines(self) -> None:
        for cell, glyph in _line_glyphs(self._drawing, self._selected_links, self._glyphs):
            is_selected = glyph in self._glyphs.heavy.values()
            self._put(cell, glyph, SELECTED_ROLE if is_selected else LINE_ROLE)
        columns, layout = self._drawing.columns, self._drawing.layout
        for item in self._drawing.graph.items:
            if item.senders:
                self._put(
                    GraphCell(columns.item_start - 2, layout.items[item.label]), self._glyphs.arrow, LINE_ROLE
                )
        for row in layout.receivers.rows.values():
            self._put(GraphCell(columns.receiver_start - 2, row), self._glyphs.arrow, LINE_ROLE)

    def draw_mismatches(self) -> None:
        """Marks the lines on which something is not delivered, where they leave the common one."""
        for item in self._drawing.graph.items:
            for _, receiver in item.undelivered:
                route = self._drawing.routes[GraphLink(receiver, item.label, is_sender=False)]
                self._put(route.branch_cell, self._glyphs.mismatch, MISMATCH_ROLE)
                self._text_cells.add(route.branch_cell)

    def draw_rates(self) -> None:
        columns = self._drawing.columns
        for label, rate in self._view.rates.items():
            row = self._drawing.layout.items.get(label)
            if row is not None:
                text = rate_text(rate)
                start = columns.item_start - ARROW_WIDTH - 1 - len(text)
                self._write(GraphCell(start, row), text, RATE_ROLE)

    def draw_messages(self) -> None:
        for cell in self._view.message_cells:
            if cell not in self._text_cells:
                self._put(cell, self._glyphs.message, MESSAGE_ROLE)

    def draw_names(self) -> None:
        columns, selected = self._drawing.columns, self._view.selected
        starts = {"sender": 0, "item": columns.item_start, "receiver": columns.receiver_start}
        widths = {
            "sender": columns.node_width,
            "item": columns.item_width,
            "receiver": columns.width - columns.receiver_start,
        }
        for element, row in self._drawing.element_rows().items():
            text = _shorten_name(element.name, widths[element.column] - 2, self._glyphs.ellipsis)
            is_selected = selected is not None and element.name == selected.name
            start = starts[element.column] + 1
            self._write(GraphCell(start, row), text, SELECTED_ROLE if is_selected else NAME_ROLE)
            if is_selected:
                self._put(GraphCell(start - 1, row), "[", SELECTED_ROLE)
                self._put(GraphCell(start + len(text), row), "]", SELECTED_ROLE)

    def _write(self, start: GraphCell, text: str, role: Role) -> None:
        for column, glyph in enumerate(text, start.column):
            cell = GraphCell(column, start.row)
            self._put(cell, glyph, role)
            self._text_cells.add(cell)

    def _put(self, cell: GraphCell, glyph: str, role: Role) -> None:
        rows, columns = self.frame.shape
        row = cell.row - self._view.first_row
        if 0 <= row < rows and 0 <= cell.column < columns:
            self.frame.glyphs[row, cell.column] = np.uint32(ord(glyph))
            self.frame.fg[row, cell.column] = role


def _line_glyphs(
    drawing: GraphDrawing, selected: Collection[GraphLink], glyphs: LineGlyphs
) -> Iterator[tuple[GraphCell, str]]:
    """The character of each cell that has a line."""
    horizontal: dict[GraphCell, int] = {}
    vertical: dict[GraphCell, int] = {}
    bends: dict[GraphCell, int] = {}
    heavy: dict[GraphCell, int] = {}
    solid: set[GraphCell] = set()
    services = {item.label for item in drawing.graph.items if item.is_service}
    for link, route in drawing.routes.items():
        for cell, leads in route.cells:
            if leads == HORIZONTAL:
                horizontal[cell] = HORIZONTAL
            elif leads == VERTICAL:
                vertical[cell] = VERTICAL
            else:
                bends[cell] = bends.get(cell, 0) | leads
            if link in selected:
                heavy[cell] = heavy.get(cell, 0) | leads
        if link.item not in services:
            solid.update(cell for cell, leads in route.cells if leads == HORIZONTAL)
    for cell in horizontal.keys() | vertical.keys() | bends.keys():
        if cell in heavy:
            yield cell, glyphs.heavy[heavy[cell]]
        elif cell in bends:  # here lines meet: whatever passes belongs to them
            yield cell, glyphs.light[bends[cell] | horizontal.get(cell, 0) | vertical.get(cell, 0)]
        elif cell in horizontal:
            yield cell, (glyphs.light if cell in solid else glyphs.dashed)[HORIZONTAL]
        else:
            yield cell, glyphs.light[VERTICAL]


def _shorten_name(name: str, width: int, mark: str) -> str:
    """The name, or as much of its end as there is room for: the end says what it is."""
    if len(name) <= width:
        return name
    kept = max(0, width - len(mark))
    return mark + name[len(name) - kept :]


_COLUMNS: tuple[ColumnName, ...] = ("sender", "item", "receiver")


def initial_selection(drawing: GraphDrawing) -> GraphElement | None:
    """Returns the first selection: an item with a mismatch, else the topmost topic, else a node."""
    mismatched = [GraphElement("item", item.label) for item in drawing.graph.items if item.undelivered]
    rows = drawing.element_rows()
    return min(
        mismatched or rows, key=lambda element: (element.column != "item", rows[element]), default=None
    )


def kept_selection(drawing: GraphDrawing, selected: GraphElement | None, row: int) -> GraphElement | None:
    """Returns the same element, or the one nearest to its row if it is gone."""
    rows = drawing.element_rows()
    if selected is None or not rows:
        return initial_selection(drawing)
    if selected in rows:
        return selected
    return min(rows, key=lambda other: (other.column != selected.column, abs(rows[other] - row)))


def move_vertically(drawing: GraphDrawing, selected: GraphElement, steps: int) -> GraphElement:
    """Returns the element ``steps`` further down its column, or up."""
    rows = drawing.element_rows()
    column = sorted(
        (other for other in rows if other.column == selected.column), key=lambda other: rows[other]
    )
    return column[min(max(column.index(selected) + steps, 0), len(column) - 1)]


def move_horizontally(drawing: GraphDrawing, selected: GraphElement, steps: int) -> GraphElement:
    """One column to the right, or left: along a line if there is one, to the nearest row."""
    number = _COLUMNS.index(selected.column) + steps
    if not 0 <= number < len(_COLUMNS):
        return selected
    rows = drawing.element_rows()
    beside = [other for other in rows if other.column == _COLUMNS[number]]
    if not beside:
        return selected
    return min(
        beside,
        key=lambda other: (not _are_linked(drawing, selected, other), abs(rows[other] - rows[selected])),
    )


def _are_linked(drawing: GraphDrawing, one: GraphElement, other: GraphElement) -> bool:
    node, item = (other, one) if one.column == "item" else (one, other)
    return GraphLink(node.name, item.name, is_sender=node.column == "sender") in drawing.routes


FRAMES_PER_LEG: Final = 6
"""Frames that a dot takes from a node to a topic, and from there to the next node."""

MAX_DOTS: Final = 16
"""Dots that are under way at once; of more flows than that some have to wait."""


@dataclass(frozen=True, slots=True)
class _MovingDot:
    flow: MessageFlow
    legs: tuple[tuple[GraphLink, ...], tuple[GraphLink, ...]]
    """First one line, or none where the sender's is not drawn, then all that lead on."""
    is_response: bool
    """An answer: from the server to the client."""
    frame: int = 0

    @property
    def links(self) -> tuple[GraphLink, ...]:
        return self.legs[self.frame // FRAMES_PER_LEG]


class MessageAnimation:
    """The moving dots. Call ``advance`` at a steady rate while it ``is_active`` or message counts change."""

    def __init__(self) -> None:
        self._counts: dict[MessageFlow, int] | None = None
        self._waiting: dict[MessageFlow, None] = {}
        self._dots: list[_MovingDot] = []

    @property
    def is_active(self) -> bool:
        return bool(self._dots or self._waiting)

    def update_counts(self, flow_stats: Mapping[MessageFlow, FlowStats]) -> None:
        """Updates the message counts; those of the first call are the baseline."""
        counts = {flow: heard.count for flow, heard in flow_stats.items()}
        if self._counts is not None:
            news = (flow for flow, number in counts.items() if number != self._counts.get(flow))
            self._waiting |= dict.fromkeys(news)
        self._counts = counts

    def advance(self, graph: GraphData) -> None:
        """Moves each dot on, and lets new ones leave where the line is free."""
        moved = (replace(dot, frame=dot.frame + 1) for dot in self._dots)
        self._dots = [dot for dot in moved if dot.frame < 2 * FRAMES_PER_LEG and dot.links]
        items = {(item.name, item.is_service): item for item in graph.items}
        departing = {dot.flow for dot in self._dots if dot.frame < FRAMES_PER_LEG}
        waiting, self._waiting = self._waiting, {}
        for flow in waiting:
            item = items.get((flow.name, flow.is_service))
            if item is None:
                continue
            if flow in departing or len(self._dots) >= MAX_DOTS:
                self._waiting[flow] = None
            elif (dot := _new_dot(flow, item)) is not None:
                self._dots.append(dot)

    def cells(self, drawing: GraphDrawing) -> frozenset[GraphCell]:
        """Returns the cells of the dots."""
        return frozenset(
            cell
            for dot in self._dots
            for link in dot.links
            if (cell := _cell_of(dot, link, drawing)) is not None
        )


def _new_dot(flow: MessageFlow, item: GraphItem) -> _MovingDot | None:
    """Returns a dot for a new message; None if its sender is no longer linked."""
    if flow.response_to is not None:
        if flow.node not in item.receivers or flow.response_to not in item.senders:
            return None
        first, then = (
            GraphLink(flow.node, item.label, is_sender=False),
            GraphLink(flow.response_to, item.label, is_sender=True),
        )
        return _MovingDot(flow, ((first,), (then,)), is_response=True)
    if flow.node not in item.senders:
        return None
    heard = tuple(
        GraphLink(node, item.label, is_sender=False)
        for node in item.receivers
        if (flow.node, node) not in item.undelivered
    )
    return _MovingDot(flow, ((GraphLink(flow.node, item.label, is_sender=True),), heard), is_response=False)


def _cell_of(dot: _MovingDot, link: GraphLink, drawing: GraphDrawing) -> GraphCell | None:
    if link not in drawing.routes:  # it has left meanwhile
        return None
    cells = drawing.link_cells(link)
    position = (2 * (dot.frame % FRAMES_PER_LEG) + 1) * len(cells) // (2 * FRAMES_PER_LEG)
    return cells[-1 - position if dot.is_response else position]
