"""Proves that a robot gets from a map's start to its target, and finds the narrowest passage of its widest way."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from kit.fields.occupancy_grid import BoolArray, Cell, OccupancyGrid

ROBOT_RADIUS: Final = 0.13
"""Radius of the circle that the kit's robot turns in [m]."""
Point = tuple[float, float]


class NoRoute(ValueError):
    """No way leads from the start to the target; the message says how wide the widest gap is."""


@dataclass(frozen=True, slots=True)
class Route:
    """The widest way from start to target."""

    points: tuple[Point, ...]
    """[m], a cell apart."""
    narrowest: Point
    width: float
    """Free width at the narrowest place [m]."""

    @property
    def length(self) -> float:
        """[m]"""
        return sum(math.dist(a, b) for a, b in pairwise(self.points))


def widest_route(grid: OccupancyGrid, start: Point, target: Point, radius: float = ROBOT_RADIUS) -> Route:
    """The way whose narrowest place is widest, and of those the shortest. Raises NoRoute if the robot does not fit."""
    first, last = grid.cell_at(*start), grid.cell_at(*target)
    width = grid.widest_passage(start, target)
    if width <= radius:
        raise NoRoute(
            f"No way leads from ({start[0]:.2f}, {start[1]:.2f}) to ({target[0]:.2f}, {target[1]:.2f}) for a robot that needs "
            f"{2 * radius:.2f} m: its widest way is {2 * width:.2f} m wide. Open the wall there, or give the map a larger scale."
        )
    cells = _shortest(grid.clearance > max(width - 1e-9, 0.75 * grid.cell_size), first, last)
    narrow = min(cells, key=lambda cell: grid.clearance[cell])
    return Route(
        tuple(grid.cell_center(cell) for cell in cells),
        grid.cell_center(narrow),
        2 * float(grid.clearance[narrow]),
    )


def farthest_apart(grid: OccupancyGrid, radius: float = ROBOT_RADIUS) -> tuple[Point, Point]:
    """Two places that are far apart for a robot of that radius, with room around both. Raises NoRoute."""
    roomy = grid.inside & (grid.clearance > 1.5 * radius)
    if not roomy.any():
        raise NoRoute(f"A robot that needs {2 * radius:.2f} m fits nowhere. Give the map a larger scale.")
    free = grid.inside & (grid.clearance > radius)
    cells: list[Cell] = [(row, column) for row, column in np.argwhere(roomy).tolist()]
    begin = max(cells, key=lambda cell: grid.clearance[cell])
    one = _last_reached(free, roomy, begin)
    return grid.cell_center(one), grid.cell_center(_last_reached(free, roomy, one))


def _shortest(free: BoolArray, first: Cell, last: Cell) -> list[Cell]:
    before: dict[Cell, Cell] = {first: first}
    ring = [first]
    while last not in before and ring:
        following = []
        for cell in ring:
            for other in _neighbours(free.shape, cell):
                if free[other] and other not in before:
                    before[other] = cell
                    following.append(other)
        ring = following
    cells = [last]
    while cells[-1] != first:
        cells.append(before[cells[-1]])
    return cells[::-1]


def _last_reached(free: BoolArray, roomy: BoolArray, begin: Cell) -> Cell:
    """The roomy cell that is reached last from ``begin``."""
    been, ring, last = np.zeros_like(free), [begin], begin
    been[begin] = True
    while ring:
        following = []
        for cell in ring:
            if roomy[cell]:
                last = cell
            for other in _neighbours(free.shape, cell):
                if free[other] and not been[other]:
                    been[other] = True
                    following.append(other)
        ring = following
    return last


def _neighbours(shape: tuple[int, ...], cell: Cell) -> list[Cell]:
    row, column = cell
    found = [(row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)]
    return [(r, c) for r, c in found if 0 <= r < shape[0] and 0 <= c < shape[1]]
