"""A small model of a driving task, a grid of places and headings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from grader.assignment import GridTask
from kit.arrays import BoolArray, FloatArray, IntArray

CELL: Final = 0.25
"""m"""
HEADINGS: Final = 8
MOVES: Final = ("forward", "back", "left", "right")
FORWARD, BACK, LEFT, RIGHT = range(4)

NO_MOVE: Final = 4
"""The last move of a start state: none."""
LAST_MOVES: Final = len(MOVES) + 1

HEADING_STEPS: Final = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
"""Next cell (columns, rows up) for each heading, counter-clockwise from x."""

MAX_RANGE: Final = 10.0
"""m: the most free distance ahead that the model knows."""


@dataclass(frozen=True, eq=False)
class GridModel:
    """All states and transitions of one task. A state is a number: ``(cell * HEADINGS + heading) * LASTS + last``."""

    task: GridTask
    cells: IntArray
    """(n, 2) column and row (from below) of every cell of floor."""
    target: int
    """The number of the target's cell."""
    next: IntArray
    """(states, moves) the state after; the same place after a collision."""
    hit: BoolArray
    """(states, moves) whether the move runs into a wall."""
    reached: BoolArray
    """(states, moves) whether the move enters the target."""

    @property
    def states(self) -> int:
        return len(self.next)

    @property
    def done(self) -> BoolArray:
        """(states, moves) whether the episode ends."""
        return self.hit | self.reached

    @property
    def starts(self) -> IntArray:
        """Every state in which an episode may begin: not in the target, no move before."""
        states: IntArray = np.arange(self.states)
        begin: IntArray = states[(self.cell_of(states) != self.target) & (states % LAST_MOVES == NO_MOVE)]
        return begin

    def cell_of(self, states: IntArray) -> IntArray:
        return states // (HEADINGS * LAST_MOVES)

    def heading_of(self, states: IntArray) -> IntArray:
        return states // LAST_MOVES % HEADINGS

    def pose(self, states: IntArray) -> FloatArray:
        """(..., 3) ``x y theta`` [m, m, rad]"""
        middle = (self.cells[self.cell_of(states)] + 0.5) * CELL
        return np.concatenate([middle, (self.heading_of(states) * (np.pi / 4))[..., None]], axis=-1)

    @cached_property
    def ahead(self) -> FloatArray:
        """(cells, HEADINGS) free distance ahead [m]: from a cell's centre to the nearest wall's edge."""
        floor = {tuple(cell): number for number, cell in enumerate(self.cells.tolist())}
        room = np.zeros((len(self.cells), HEADINGS))
        for number, (column, row) in enumerate(self.cells.tolist()):
            for heading, (dx, dy) in enumerate(HEADING_STEPS):
                free = 0
                while (column + (free + 1) * dx, row + (free + 1) * dy) in floor:
                    free += 1
                room[number, heading] = min(MAX_RANGE, (free + 0.5) * CELL * float(np.hypot(dx, dy)))
        return room

    @cached_property
    def to_target(self) -> FloatArray:
        """(cells,) distance to the target in a straight line [m]"""
        distance: FloatArray = CELL * np.hypot(*(self.cells - self.cells[self.target]).T)
        return distance

    @cached_property
    def to_go(self) -> FloatArray:
        """(cells,) length of the shortest path to the target [m]; infinite where there is none."""
        length = np.full(len(self.cells), np.inf)
        length[self.target] = 0.0
        number = {tuple(cell): index for index, cell in enumerate(self.cells.tolist())}
        waiting = [self.target]
        while waiting:
            at = waiting.pop(0)
            column, row = self.cells[at].tolist()
            for dx, dy in HEADING_STEPS:
                beside = number.get((column + dx, row + dy))
                far = length[at] + CELL * float(np.hypot(dx, dy))
                if beside is not None and far < length[beside] - 1e-9:
                    length[beside] = far
                    waiting.append(beside)
        return length


def build_model(task: GridTask) -> GridModel:
    """Builds the model of a map drawn in characters."""
    rows = task.rows[::-1]
    cells = [(x, y) for y, row in enumerate(rows) for x, sign in enumerate(row) if sign != "#"]
    number = {cell: index for index, cell in enumerate(cells)}
    target = next(index for (x, y), index in number.items() if rows[y][x] == "G")
    states = len(cells) * HEADINGS * LAST_MOVES
    after = np.zeros((states, len(MOVES)), dtype=np.int64)
    hit = np.zeros((states, len(MOVES)), dtype=np.bool_)
    for cell, (x, y) in enumerate(cells):
        for heading in range(HEADINGS):
            first = (cell * HEADINGS + heading) * LAST_MOVES
            for move, (to, turned, is_hit) in enumerate(_move_results(number, x, y, heading)):
                after[first : first + LAST_MOVES, move] = (to * HEADINGS + turned) * LAST_MOVES + move
                hit[first : first + LAST_MOVES, move] = is_hit
    reached = (after // (HEADINGS * LAST_MOVES) == target) & (
        np.arange(states) // (HEADINGS * LAST_MOVES) != target
    )[:, None]
    return GridModel(task, np.array(cells, dtype=np.int64), target, after, hit, reached & ~hit)


def _move_results(
    number: Mapping[tuple[int, int], int], x: int, y: int, heading: int
) -> Sequence[tuple[int, int, bool]]:
    """Returns for each move the cell and heading after it, and whether it collides."""
    here = number[x, y]
    dx, dy = HEADING_STEPS[heading]
    driven = []
    for sign in (1, -1):
        # Between two walls that touch at a corner nothing passes.
        entered = ((x + sign * dx, y + sign * dy), (x + sign * dx, y), (x, y + sign * dy))
        free = all(cell in number for cell in entered)
        driven.append((number[entered[0]] if free else here, heading, not free))
    return (*driven, (here, (heading + 1) % HEADINGS, False), (here, (heading - 1) % HEADINGS, False))
