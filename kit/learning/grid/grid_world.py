"""A small world of square cells in which every value can be seen: a map in characters, four moves, exact rewards.

A robot stands in a cell and moves right, up, left or down. A move into a wall or over the edge leaves it where it is.
The targets and a cliff end the episode (Sutton and Barto, Reinforcement Learning, 2nd edition, example 6.6, where the
cliff puts the robot back to the start instead).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

from kit.breadth_first import reached_from

MOVE_NAMES: Final = ("right", "up", "left", "down")
"""Moves by number: quarter turns, counter-clockwise from the right."""
OFFSETS: Final = ((0, 1), (-1, 0), (0, -1), (1, 0))
"""Rows down and columns to the right, by move."""
FLOOR, WALL, START, TARGET, SMALL_TARGET, CLIFF = ".#SGgC"
SIGNS: Final = FLOOR + WALL + START + TARGET + SMALL_TARGET + CLIFF
MAX_CELLS: Final = 400


class GridCell(NamedTuple):
    row: int
    """From the top, counted from 0."""
    column: int


class GridStep(NamedTuple):
    """What one move led to."""

    cell: GridCell
    reward: float
    terminated: bool


@dataclass(frozen=True, slots=True)
class GridRewards:
    """The reward of a move, by where it leads."""

    step: float = 0.0
    """Anywhere else."""
    target: float = 1.0
    small_target: float = 0.3
    cliff: float = -100.0


class GridMapError(ValueError):
    """A map is not a grid world; the message says why."""


@dataclass(frozen=True)
class GridWorld:
    """One map and its rewards.

    >>> world = GridWorld(("S.G",), GridRewards(step=0.0, target=1.0))
    >>> world.step(GridCell(0, 1), 0)
    GridStep(cell=GridCell(row=0, column=2), reward=1.0, terminated=True)
    """

    rows: tuple[str, ...]
    """From the top: ``.`` floor, ``#`` wall, ``S`` start, ``G`` target, ``g`` small target, ``C`` cliff. Beyond
    the edge is wall."""
    rewards: GridRewards = GridRewards()

    def __post_init__(self) -> None:
        """Raises GridMapError."""
        signs = "".join(self.rows)
        if not signs or len({len(row) for row in self.rows}) != 1:
            raise GridMapError("the rows of the map must have the same length")
        if unknown := set(signs) - set(SIGNS):
            raise GridMapError(f"the map has {min(unknown)!r}; it is made of {' '.join(SIGNS)}")
        if signs.count(START) != 1 or TARGET not in signs:
            raise GridMapError("the map needs one start S and a target G")
        if len(signs) > MAX_CELLS:
            raise GridMapError(f"the map has {len(signs)} cells; at most {MAX_CELLS} can be shown")
        if self.shortest_path_length is None:
            raise GridMapError("there is no path from S to G")

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return len(self.rows), len(self.rows[0])

    def number_of(self, cell: GridCell) -> int:
        """The cell's place among all cells, row by row from the top."""
        return cell.row * self.shape[1] + cell.column

    @cached_property
    def start(self) -> GridCell:
        return next(cell for cell in self.cells() if self.sign(cell) == START)

    @cached_property
    def shortest_path_length(self) -> int | None:
        """Moves from the start to the nearest G, past no other end; None if none can be reached."""
        return next(
            (
                len(moves)
                for cell, moves in reached_from(self.start, self._moves_past_ends)
                if self.sign(cell) == TARGET
            ),
            None,
        )

    def _moves_past_ends(self, cell: GridCell) -> Iterator[tuple[int, GridCell]]:
        """The moves from a cell that end at neither a small target nor a cliff, each with the cell that it leads to."""
        for move in range(len(MOVE_NAMES)):
            reached = self._neighbor(cell, move)
            if self.sign(reached) not in (SMALL_TARGET, CLIFF):
                yield move, reached

    def cells(self) -> Iterator[GridCell]:
        """Every cell, row by row."""
        for row, signs in enumerate(self.rows):
            for column in range(len(signs)):
                yield GridCell(row, column)

    def sign(self, cell: GridCell) -> str:
        return self.rows[cell.row][cell.column]

    def is_terminal(self, cell: GridCell) -> bool:
        return self.sign(cell) in (TARGET, SMALL_TARGET, CLIFF)

    def step(self, cell: GridCell, move: int) -> GridStep:
        """``move``: 0 to 3, as in ``MOVE_NAMES``."""
        reached = self._neighbor(cell, move)
        sign = self.sign(reached)
        rewards = self.rewards
        ends = {TARGET: rewards.target, SMALL_TARGET: rewards.small_target, CLIFF: rewards.cliff}
        reward = ends.get(sign, rewards.step)
        return GridStep(reached, reward, self.is_terminal(reached))

    def _neighbor(self, cell: GridCell, move: int) -> GridCell:
        down, right = OFFSETS[move]
        row, column = cell.row + down, cell.column + right
        inside = 0 <= row < len(self.rows) and 0 <= column < len(self.rows[0])
        return GridCell(row, column) if inside and self.rows[row][column] != WALL else cell
