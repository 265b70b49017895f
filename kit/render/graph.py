"""Draws the ROS graph in characters: nodes left and right, topics and services between them, lines and what moves on them.

Two lines that cross do not touch: the level one is drawn through. They touch where a corner or a tee is drawn.
The selected element stands in brackets, and its lines are thick; a service's lines are dashed. So no meaning hangs on
colour.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

import numpy as np

from kit.render.encode import Frame
from kit.render.graph_columns import ARROW_WIDTH
from kit.render.graph_drawing import GraphCell, GraphDrawing, GraphElement, GraphLink
from kit.render.graph_glyphs import HORIZONTAL, UNICODE_LINES, VERTICAL, LineGlyphs
from kit.render.roles import Role

LINE_ROLE: Final = Role.WALL
NAME_ROLE: Final = Role.WALL
SELECTED_ROLE: Final = Role.ROBOT
MESSAGE_ROLE: Final = Role.HIT
MISMATCH_ROLE: Final = Role.CONTACT
RATE_ROLE: Final = Role.TRAIL
"""Roles of the world's palette as used for the graph."""


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
