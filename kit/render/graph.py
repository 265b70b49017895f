"""A conversation in characters: nodes left and right, topics and services between them, lines and what moves on them.

Two lines that cross do not touch: the level one is drawn through. They touch where a corner or a tee is drawn.
What is chosen stands in brackets, and its lines are thick; a service's lines are dashed. So no meaning hangs on
colour.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Final, Literal, NamedTuple

import numpy as np

from kit.render.frame import Frame
from kit.render.graph_data import Conversation, Item
from kit.render.graph_layout import Places
from kit.render.roles import Role

Column = Literal["sender", "item", "receiver"]

LINE: Final = Role.WALL
NAME: Final = Role.WALL
CHOSEN: Final = Role.ROBOT
MESSAGE: Final = Role.HIT
BROKEN: Final = Role.CONTACT
RATE: Final = Role.TRAIL
"""What the inks of the world's picture stand for in this one."""


class Spot(NamedTuple):
    """A node or an item of the picture. A node that sends and receives is in two spots."""

    column: Column
    name: str
    """The node's full name or the item's label."""


class Link(NamedTuple):
    """A node's line to an item, or an item's to a node."""

    node: str
    item: str
    """Its label."""
    sends: bool
    """Whether it leads from the node to the item."""


class Cell(NamedTuple):
    column: int
    row: int


@dataclass(frozen=True, slots=True)
class Columns:
    """Where the columns begin and how wide they are."""

    width: int
    nodes: int
    """Of each column of nodes."""
    left: int
    """Between senders and items: lanes, then the rate, then the arrow."""
    items: int
    right: int
    """Between items and receivers: lanes, then the arrow."""
    pitch: tuple[int, int]
    """Characters from one lane to the next, left and right."""

    @property
    def item(self) -> int:
        """The first character of the items."""
        return self.nodes + self.left

    @property
    def receiver(self) -> int:
        """The first character of the receivers."""
        return self.item + self.items + self.right


RATE_ROOM: Final = 8
ARROW_ROOM: Final = 2
LEAST_LANES: Final = (5, 8)
"""Characters kept for lanes, left and right, so that the columns stay where they are when one joins."""
LEAST_NAME: Final = 8


def columns(width: int, places: Places) -> Columns:
    """The columns for a picture of this width: what lanes need beyond the usual is taken from the names."""
    needed = [max(side.lanes.values(), default=-1) + 1 for side in (places.senders, places.receivers)]
    left, right = (max(least, lanes) for least, lanes in zip(LEAST_LANES, needed, strict=True))
    names = max(3 * LEAST_NAME, width - left - right - RATE_ROOM - 2 * ARROW_ROOM)
    nodes = names // 3
    pitches = tuple(
        2 if lanes and 2 * lanes <= room else 1 for lanes, room in zip(needed, (left, right), strict=True)
    )
    return Columns(
        width,
        nodes,
        left + RATE_ROOM + ARROW_ROOM,
        names - 2 * nodes,
        right + ARROW_ROOM,
        (pitches[0], pitches[1]),
    )


EAST, NORTH, WEST, SOUTH = 1, 2, 4, 8
LEVEL, UPRIGHT = EAST | WEST, NORTH | SOUTH


@dataclass(frozen=True, slots=True)
class Strokes:
    """The characters of lines, by where they lead; and the other signs."""

    light: Mapping[int, str]
    heavy: Mapping[int, str]
    dashed: Mapping[int, str]
    arrow: str
    message: str
    broken: str
    cut: str
    """Stands for the beginning of a name that is too long."""


def _table(level: str, upright: str, corners: str) -> Mapping[int, str]:
    joints = (EAST | SOUTH, WEST | SOUTH, NORTH | EAST, NORTH | WEST, UPRIGHT | EAST, UPRIGHT | WEST)
    tees = (*joints, LEVEL | SOUTH, LEVEL | NORTH, LEVEL | UPRIGHT)
    straight = {EAST: level, WEST: level, LEVEL: level, NORTH: upright, SOUTH: upright, UPRIGHT: upright}
    return MappingProxyType({**straight, **dict(zip(tees, corners, strict=True))})


_LIGHT = "┌┐└┘├┤┬┴┼"
BOX: Final = Strokes(
    _table("─", "│", _LIGHT),
    _table("━", "┃", "┏┓┗┛┣┫┳┻╋"),
    _table("╌", "│", _LIGHT),
    arrow="▶",
    message="●",
    broken="✗",
    cut="…",
)
PLAIN: Final = Strokes(
    _table("-", "|", "+" * 9),
    _table("=", "|", "#" * 9),
    _table(".", "|", "+" * 9),
    arrow=">",
    message="o",
    broken="X",
    cut="~",
)


@dataclass(frozen=True, slots=True)
class _Way:
    """A link's cells from the sender to the receiver, and where they lead."""

    cells: tuple[tuple[Cell, int], ...]
    joint: Cell
    """Where the node's lane meets the item's row; the middle of the line if it is straight."""


@dataclass(frozen=True)
class Plan:
    """Where everything of a conversation is drawn, in a picture of this width."""

    talk: Conversation
    places: Places
    width: int

    @cached_property
    def columns(self) -> Columns:
        return columns(self.width, self.places)

    @cached_property
    def ways(self) -> Mapping[Link, _Way]:
        ways: dict[Link, _Way] = {}
        for item in self.talk.items:
            for node in item.senders:
                ways[Link(node, item.label, sends=True)] = self._way_in(node, item)
            for node in item.receivers:
                ways[Link(node, item.label, sends=False)] = self._way_out(node, item)
        return ways

    def path(self, link: Link) -> tuple[Cell, ...]:
        """The characters that a message on this link goes through, from sender to receiver."""
        return tuple(cell for cell, _ in self.ways[link].cells)

    def links_of(self, spot: Spot | None) -> Collection[Link]:
        """The lines of what is chosen: a node's on both its sides."""
        if spot is None:
            return ()
        return {
            link for link in self.ways if spot.name == (link.item if spot.column == "item" else link.node)
        }

    def spots(self) -> Mapping[Spot, int]:
        """Everything that can be chosen, with its row."""
        rows = {Spot("sender", node): row for node, row in self.places.senders.seats.items()}
        rows |= {Spot("item", label): row for label, row in self.places.items.items()}
        return rows | {Spot("receiver", node): row for node, row in self.places.receivers.seats.items()}

    def _way_in(self, node: str, item: Item) -> _Way:
        columns, seat, row = self.columns, self.places.senders.seats[node], self.places.items[item.label]
        start, end = min(len(node), columns.nodes - 2) + 2, columns.item - 1
        lane = self.places.senders.lanes.get(node)
        at = None if lane is None else columns.nodes + lane * columns.pitch[0]
        return _bent(start, end, at, seat, row)

    def _way_out(self, node: str, item: Item) -> _Way:
        columns, seat, row = self.columns, self.places.receivers.seats[node], self.places.items[item.label]
        start = columns.item + min(len(item.label), columns.items - 2) + 2
        end = columns.receiver - 1
        lane = self.places.receivers.lanes.get(node)
        at = None if lane is None else columns.receiver - ARROW_ROOM - 1 - lane * columns.pitch[1]
        return _bent(start, end, at, row, seat)


def _bent(start: int, end: int, lane: int | None, first: int, last: int) -> _Way:
    """A way along row ``first`` to the lane, along that, and on row ``last`` to the end (exclusive)."""
    if lane is None:
        cells = [(Cell(column, first), LEVEL) for column in range(start, end)]
        return _Way(tuple(cells), cells[len(cells) // 2][0])
    cells = [(Cell(column, first), LEVEL) for column in range(start, lane)]
    if first == last:
        cells.append((Cell(lane, first), LEVEL))
    else:
        down = last > first
        onward, back = (SOUTH, NORTH) if down else (NORTH, SOUTH)
        cells.append((Cell(lane, first), WEST | onward))
        cells += [
            (Cell(lane, row), UPRIGHT) for row in range(first + (1 if down else -1), last, 1 if down else -1)
        ]
        cells.append((Cell(lane, last), back | EAST))
    cells += [(Cell(column, last), LEVEL) for column in range(lane + 1, end)]
    return _Way(tuple(cells), Cell(lane, first))


@dataclass(frozen=True, slots=True)
class Sight:
    """What is to be seen on the lines, and which part of the picture."""

    rates: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    """Messages per second, by an item's label."""
    chosen: Spot | None = None
    messages: Collection[Cell] = ()
    """Where messages are just now."""
    top: int = 0
    """The first row shown."""


def draw(plan: Plan, sight: Sight, rows: int, strokes: Strokes = BOX) -> Frame:
    """The picture, ``plan.width`` x ``rows`` characters."""
    pen = _Pen(plan, sight, rows, strokes)
    pen.lines()
    pen.breaks()
    pen.rates()
    pen.messages()
    pen.names()
    return pen.frame


def rate_text(rate: float) -> str:
    """Up to seven characters: ``0.5 Hz``, ``10 Hz``, ``1.2 kHz``."""
    if rate >= 1000:
        return f"{rate / 1000:.2g} kHz"
    return f"{rate:.0f} Hz" if rate >= 9.5 else f"{rate:.2g} Hz"


class _Pen:
    def __init__(self, plan: Plan, sight: Sight, rows: int, strokes: Strokes) -> None:
        self._plan, self._sight, self._strokes = plan, sight, strokes
        self._chosen = plan.links_of(sight.chosen)
        self.frame = Frame.empty(plan.width, rows)
        self._words: set[Cell] = set()

    def lines(self) -> None:
        for cell, glyph in _strokes_of(self._plan, self._chosen, self._strokes):
            is_chosen = glyph in self._strokes.heavy.values()
            self._put(cell, glyph, CHOSEN if is_chosen else LINE)
        columns, places = self._plan.columns, self._plan.places
        for item in self._plan.talk.items:
            if item.senders:
                self._put(Cell(columns.item - 2, places.items[item.label]), self._strokes.arrow, LINE)
        for row in places.receivers.seats.values():
            self._put(Cell(columns.receiver - 2, row), self._strokes.arrow, LINE)

    def breaks(self) -> None:
        """Marks the lines on which something is not delivered, where they leave the common one."""
        for item in self._plan.talk.items:
            for _, receiver in item.broken:
                way = self._plan.ways[Link(receiver, item.label, sends=False)]
                self._put(way.joint, self._strokes.broken, BROKEN)
                self._words.add(way.joint)

    def rates(self) -> None:
        columns = self._plan.columns
        for label, rate in self._sight.rates.items():
            row = self._plan.places.items.get(label)
            if row is not None:
                text = rate_text(rate)
                start = columns.item - ARROW_ROOM - 1 - len(text)
                self._write(Cell(start, row), text, RATE)

    def messages(self) -> None:
        for cell in self._sight.messages:
            if cell not in self._words:
                self._put(cell, self._strokes.message, MESSAGE)

    def names(self) -> None:
        columns, chosen = self._plan.columns, self._sight.chosen
        first = {"sender": 0, "item": columns.item, "receiver": columns.receiver}
        room = {"sender": columns.nodes, "item": columns.items, "receiver": columns.width - columns.receiver}
        for spot, row in self._plan.spots().items():
            text = _cut(spot.name, room[spot.column] - 2, self._strokes.cut)
            is_chosen = chosen is not None and spot.name == chosen.name
            start = first[spot.column] + 1
            self._write(Cell(start, row), text, CHOSEN if is_chosen else NAME)
            if is_chosen:
                self._put(Cell(start - 1, row), "[", CHOSEN)
                self._put(Cell(start + len(text), row), "]", CHOSEN)

    def _write(self, start: Cell, text: str, role: Role) -> None:
        for column, glyph in enumerate(text, start.column):
            cell = Cell(column, start.row)
            self._put(cell, glyph, role)
            self._words.add(cell)

    def _put(self, cell: Cell, glyph: str, role: Role) -> None:
        rows, columns = self.frame.shape
        row = cell.row - self._sight.top
        if 0 <= row < rows and 0 <= cell.column < columns:
            self.frame.glyphs[row, cell.column] = np.uint32(ord(glyph))
            self.frame.inks[row, cell.column] = role


def _strokes_of(plan: Plan, chosen: Collection[Link], strokes: Strokes) -> Iterator[tuple[Cell, str]]:
    """The character of each cell that has a line."""
    level: dict[Cell, int] = {}
    upright: dict[Cell, int] = {}
    bends: dict[Cell, int] = {}
    heavy: dict[Cell, int] = {}
    solid: set[Cell] = set()
    services = {item.label for item in plan.talk.items if item.is_service}
    for link, way in plan.ways.items():
        for cell, leads in way.cells:
            if leads == LEVEL:
                level[cell] = LEVEL
            elif leads == UPRIGHT:
                upright[cell] = UPRIGHT
            else:
                bends[cell] = bends.get(cell, 0) | leads
            if link in chosen:
                heavy[cell] = heavy.get(cell, 0) | leads
        if link.item not in services:
            solid.update(cell for cell, leads in way.cells if leads == LEVEL)
    for cell in level.keys() | upright.keys() | bends.keys():
        if cell in heavy:
            yield cell, strokes.heavy[heavy[cell]]
        elif cell in bends:  # here lines meet: whatever passes belongs to them
            yield cell, strokes.light[bends[cell] | level.get(cell, 0) | upright.get(cell, 0)]
        elif cell in level:
            yield cell, (strokes.light if cell in solid else strokes.dashed)[LEVEL]
        else:
            yield cell, strokes.light[UPRIGHT]


def _cut(name: str, width: int, mark: str) -> str:
    """The name, or as much of its end as there is room for: the end says what it is."""
    if len(name) <= width:
        return name
    kept = max(0, width - len(mark))
    return mark + name[len(name) - kept :]
