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
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Final, Literal, NamedTuple

import numpy as np

from kit.render.encode import Frame
from kit.render.graph_data import GraphData, GraphItem
from kit.render.graph_glyphs import EAST, HORIZONTAL, NORTH, SOUTH, UNICODE_LINES, VERTICAL, WEST, LineGlyphs
from kit.render.graph_layout import GraphLayout
from kit.render.roles import Role

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
        return _route_link(start, end, lane_column, node_row, row)

    def _receiver_route(self, node: str, item: GraphItem) -> _LinkRoute:
        columns, node_row, row = self.columns, self.layout.receivers.rows[node], self.layout.items[item.label]
        start = columns.item_start + min(len(item.label), columns.item_width - 2) + 2
        end = columns.receiver_start - 1
        lane = self.layout.receivers.lanes.get(node)
        lane_column = (
            None if lane is None else columns.receiver_start - ARROW_WIDTH - 1 - lane * columns.lane_pitch[1]
        )
        return _route_link(start, end, lane_column, row, node_row)


def _route_link(start: int, end: int, lane: int | None, first: int, last: int) -> _LinkRoute:
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
            self._put_glyph(cell, glyph, SELECTED_ROLE if is_selected else LINE_ROLE)
        columns, layout = self._drawing.columns, self._drawing.layout
        for item in self._drawing.graph.items:
            if item.senders:
                self._put_glyph(
                    GraphCell(columns.item_start - 2, layout.items[item.label]), self._glyphs.arrow, LINE_ROLE
                )
        for row in layout.receivers.rows.values():
            self._put_glyph(GraphCell(columns.receiver_start - 2, row), self._glyphs.arrow, LINE_ROLE)

    def draw_mismatches(self) -> None:
        """Marks the lines on which something is not delivered, where they leave the common one."""
        for item in self._drawing.graph.items:
            for _, receiver in item.undelivered:
                route = self._drawing.routes[GraphLink(receiver, item.label, is_sender=False)]
                self._put_glyph(route.branch_cell, self._glyphs.mismatch, MISMATCH_ROLE)
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
                self._put_glyph(cell, self._glyphs.message, MESSAGE_ROLE)

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
                self._put_glyph(GraphCell(start - 1, row), "[", SELECTED_ROLE)
                self._put_glyph(GraphCell(start + len(text), row), "]", SELECTED_ROLE)

    def _write(self, start: GraphCell, text: str, role: Role) -> None:
        for column, glyph in enumerate(text, start.column):
            cell = GraphCell(column, start.row)
            self._put_glyph(cell, glyph, role)
            self._text_cells.add(cell)

    def _put_glyph(self, cell: GraphCell, glyph: str, role: Role) -> None:
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
