"""Puzzles played by keys: an answer that is made on a board, cell by cell, and judged after every key."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import accumulate, groupby
from types import MappingProxyType
from typing import ClassVar, Final, Generic, TypeAlias, TypeVar

from kit.breadth_first import reached_from
from kit.document.blocks import Cell as TableCell
from kit.document.blocks import labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import Row
from kit.layers.drawing.spans import GlyphStyle
from kit.school.game.judgement import Judgement

State = TypeVar("State")

WALL: Final = "#"
START, GOAL = "S", "G"
FULL, LIT = "█", "░"
"""Fill a cell: a wall, and what is seen."""
LIT_STYLE: Final = "warn"
MOVES: Final = {"l": (0, -1), "r": (0, 1), "u": (-1, 0), "d": (1, 0)}
"""The letter of each move, with its change of row and column."""
ARROWS: Final = {"l": "←", "r": "→", "u": "↑", "d": "↓"}

Cell: TypeAlias = tuple[int, int]
"""Row and column, from 0."""
Grid: TypeAlias = Sequence[str]
"""Lines of signs, ``#`` a wall."""
NO_FIGURES: Final[Mapping[Cell, tuple[str, str]]] = MappingProxyType({})
LEAST_WITH_FIGURES: Final = 3
"""The scale from which on a cell of a grid has room for a figure."""
THIRDS: Final = ("dim", "", "good")
"""Styles of the lowest, middle and highest third of values."""


class Board(ABC):
    """The state of one puzzle that is being solved. Keys change it; ``answer`` is what is handed in."""

    keys: ClassVar[str]
    """What the keys do, in one sentence."""
    signs: ClassVar[str] = ""
    """What the signs on it mean, in one sentence; empty where the task says it."""
    mark_word: ClassVar[str] = "mark"
    """What the space bar does, in one word."""

    @classmethod
    def marks(cls) -> bool:
        """Whether the space bar does something."""
        return cls.mark is not Board.mark

    @classmethod
    def switches(cls) -> bool:
        """Whether the tabulator does something."""
        return cls.switch is not Board.switch

    @property
    @abstractmethod
    def answer(self) -> str:
        """The answer as its file holds it."""

    @abstractmethod
    def rows(self, scale: int = 1) -> list[Row]:
        """The board with its cursor, and what is to be counted. ``scale``: how many times larger than usual a drawing is."""

    def drawing(self, width: int, height: int, glyphs: GlyphStyle) -> list[Row]:
        """A picture of what ``rows`` tells, at most as large; empty where there is none, or no room for it."""
        return []

    def details(self, width: int) -> list[list[Row]]:
        """More that helps to solve it, each part below its title, the most useful one first; those that are at most ``width``
        columns wide are shown where there is room."""
        return []

    def curve(self) -> tuple[str, Sequence[float]]:
        """A figure after each move, with its name; no figures for an answer that has no moves."""
        return "", ()

    @abstractmethod
    def judgement(self) -> Judgement:
        """What the answer is worth now. Raises AnswerError."""

    @abstractmethod
    def move(self, columns: int, rows: int) -> None:
        """An arrow key: one column or row, or more for the keys that go farther."""

    def mark(self) -> None:  # noqa: B027 - not every board has something to mark
        """The space bar."""

    def switch(self) -> None:  # noqa: B027 - likewise
        """The tabulator: to another robot, where there are several."""

    @abstractmethod
    def undo(self) -> None:
        """Takes the last change back."""


class History(Generic[State]):
    """States of a board before each change, so that changes can be taken back."""

    def __init__(self) -> None:
        self._states: list[State] = []

    def note(self, state: State) -> None:
        self._states.append(state)

    def take(self, present: State) -> State:
        """The state before the last change; the present one where there is none."""
        return self._states.pop() if self._states else present


def find_cell(grid: Grid, sign: str) -> Cell:
    """The first cell with this sign. Raises StopIteration if there is none."""
    return next((row, line.index(sign)) for row, line in enumerate(grid) if sign in line)


def free_cells(grid: Grid) -> tuple[Cell, ...]:
    """All cells that are no wall, row by row."""
    return tuple(
        (row, column) for row, line in enumerate(grid) for column, sign in enumerate(line) if sign != WALL
    )


def step(grid: Grid, cell: Cell, move: str) -> Cell:
    """Where a move leads to: a wall, and the edge of the grid, stop it."""
    row, column = cell[0] + MOVES[move][0], cell[1] + MOVES[move][1]
    is_inside = 0 <= row < len(grid) and 0 <= column < len(grid[row])
    return (row, column) if is_inside and grid[row][column] != WALL else cell


def cells_of_moves(grid: Grid, cell: Cell, moves: str) -> list[Cell]:
    """Where each move leads to, one after another from a cell."""
    return list(accumulate(moves, lambda here, move: step(grid, here, move), initial=cell))[1:]


def way_signs(grid: Grid, start: Cell, moves: str) -> dict[Cell, tuple[str, str]]:
    """The way of these moves as signs with their style: on each square that was left, an arrow for the last move from it.

    >>> way_signs(["#####", "#S.G#", "#####"], (1, 1), "rrll")
    {(1, 1): ('→', 'dim'), (1, 2): ('←', 'dim'), (1, 3): ('←', 'dim')}
    """
    cells = [start, *cells_of_moves(grid, start, moves)]
    return {
        here: (ARROWS[move], "dim")
        for move, here, there in zip(moves, cells, cells[1:], strict=False)
        if here != there
    }


def distances_to(grid: Grid, goal: Cell) -> dict[Cell, int]:
    """The number of moves to a cell from every cell that leads there."""
    reached = reached_from(goal, lambda cell: ((move, step(grid, cell, move)) for move in MOVES))
    return {cell: len(moves) for cell, moves in reached}  # every move can be undone by its opposite


def shortest_way(grid: Grid, start: Cell, goal: Cell) -> str:
    """The moves of a shortest way. Raises KeyError where there is none."""
    distances, cell, moves = distances_to(grid, goal), start, ""
    while distances[cell]:
        moves += next(move for move in MOVES if distances[step(grid, cell, move)] < distances[cell])
        cell = step(grid, cell, moves[-1])
    return moves


def letters_of(columns: int, rows: int) -> str:
    """The moves of an arrow key; none of keys that go farther.

    >>> letters_of(-1, 0), letters_of(0, 10)
    ('l', '')
    """
    return next((name for name, change in MOVES.items() if change == (rows, columns)), "")


def grid_rows(
    grid: Grid,
    signs: Mapping[Cell, tuple[str, str]],
    scale: int = 1,
    figures: Mapping[Cell, tuple[str, str]] = NO_FIGURES,
    lit: Collection[Cell] = (),
) -> list[Row]:
    """A grid as rows, for each cell ``scale`` rows of twice as many columns; walls at the edges of the grid are as thin as can be.
    ``signs``: sign and style of cells that differ from the drawing; the start's is kept above or below its own, and in the
    smallest cells before an arrow. ``figures``: of cells, with their style, below the sign in cells that are large enough.
    ``lit``: cells that are lit around their sign."""
    rows, columns = len(grid), max(map(len, grid))

    def is_thin(number: int, count: int, line: Iterable[str]) -> bool:
        return number in (0, count - 1) and all(sign == WALL for sign in line)

    thick = [
        1 if is_thin(column, columns, (line[column] for line in grid if column < len(line))) else scale
        for column in range(columns)
    ]

    def shown(row: int, column: int, part: int) -> Iterator[tuple[str, str]]:
        plain = grid[row][column]
        sign, style = signs.get((row, column)) or _plain_square(plain)
        if sign in (FULL, LIT):
            yield sign * 2 * thick[column], style
            return
        middle, text = (scale - 1) // 2, ""
        is_start = plain == START != sign
        if part == middle:
            text = START + sign if is_start and scale == 1 and sign in ARROWS.values() else sign
        elif is_start and part == (0 if middle else scale - 1):
            text = START
        elif part == middle + 1 and scale >= LEAST_WITH_FIGURES:
            text, figure_style = figures.get((row, column), ("", ""))
            style = style if style == "chosen" else figure_style
        placed = f"{text.center(2 * scale - 1)} "[: 2 * scale]
        if (row, column) in lit and style != "chosen":
            before = len(placed) - len(placed.lstrip()) if text else 0
            yield LIT * before, LIT_STYLE
            yield text, style
            yield LIT * (2 * scale - before - len(text)), LIT_STYLE
        else:
            yield placed, style

    return [
        (
            ("  ", ""),
            *_join_by_style(each for column in range(len(line)) for each in shown(row, column, part)),
        )
        for row, line in enumerate(grid)
        for part in range(1 if is_thin(row, rows, line) else scale)
    ]


def told_rows(title: str, told: Iterable[tuple[TableCell, ...]], width: int) -> list[Row]:
    """Names below a title, and what is said of each."""
    return [((title, "title"),), *rows_of([labelled_table(told, is_tight=True)], Page(width=width, margin=1))]


def by_value(values: Mapping[Cell, float], texts: Mapping[Cell, str]) -> dict[Cell, tuple[str, str]]:
    """The texts of values, each with a style for the third of their range that the value is in; that of an infinite one is dim.

    >>> by_value({(0, 0): 1.0, (0, 1): 5.0, (0, 2): 9.0}, {(0, 0): "1", (0, 1): "5", (0, 2): "9"})
    {(0, 0): ('1', 'dim'), (0, 1): ('5', ''), (0, 2): ('9', 'good')}
    """
    finite = [value for value in values.values() if math.isfinite(value)]
    low, high = min(finite, default=0.0), max(finite, default=0.0)

    def style(value: float) -> str:
        if not math.isfinite(value) or low == high:
            return "dim" if low != high else ""
        return THIRDS[min(2, int(3 * (value - low) / (high - low)))]

    return {cell: (texts[cell], style(value)) for cell, value in values.items()}


def figure_rows(title: str, grid: Grid, figures: Mapping[Cell, tuple[str, str]]) -> list[Row]:
    """A grid below its title, with a figure in its style in each cell that has one; walls at the edges are left out."""
    free = free_cells(grid)
    (top, bottom), (left, right) = ((min(each), max(each)) for each in zip(*free, strict=True))
    width = max((len(text) for text, _ in figures.values()), default=1) + 1

    def shown(cell: Cell) -> tuple[str, str]:
        if cell not in free:
            return FULL * width, "dim"
        text, style = figures.get(cell, (".", "dim"))
        return f"{text:>{width}}", style

    return [
        ((title, "title"),),
        *(
            tuple(_join_by_style(shown((row, column)) for column in range(left, right + 1)))
            for row in range(top, bottom + 1)
        ),
    ]


def visit_rows(grid: Grid, cells: Iterable[Cell]) -> list[Row]:
    """How often each cell of a grid was entered."""
    return figure_rows(
        "times on each square", grid, {cell: (str(count), "") for cell, count in Counter(cells).items()}
    )


def _plain_square(sign: str) -> tuple[str, str]:
    return (FULL, "dim") if sign == WALL else (sign, "good" if sign == GOAL else "")


def _join_by_style(cells: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    """Neighbours of one style as one text."""
    return [
        ("".join(text for text, _ in group), style)
        for style, group in groupby((each for each in cells if each[0]), key=lambda each: each[1])
    ]
