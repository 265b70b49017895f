"""Where a graph drawing's elements and links are: the cells of each, and what can be selected."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

from kit.render.graph_columns import ARROW_WIDTH, ColumnLayout, fit_columns
from kit.render.graph_data import GraphData, GraphItem
from kit.render.graph_glyphs import EAST, HORIZONTAL, NORTH, SOUTH, VERTICAL, WEST
from kit.render.graph_layout import GraphLayout

ColumnName = Literal["sender", "item", "receiver"]


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
