"""Proves that a robot gets from a map's start to its target, and finds the narrowest passage of its widest way."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from kit.arrays import BoolArray
from kit.fields.occupancy_grid import Cell, OccupancyGrid

ROBOT_RADIUS: Final = 0.13
"""Radius of the circle that the kit's robot turns in [m]."""
NEAREST_TARGET: Final = 0.4
"""A target nearer to the start than this [m] is reached before the robot moves."""
ROOM: Final = 0.5
"""Distance from the nearest wall [m] at which start and target are placed, if there is room."""
OPEN: Final = 1.0
"""Distance from the nearest wall [m] at which a robot is in the open; passages are searched from there."""
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
    """The way whose narrowest place is widest, and of those the shortest. Raises NoRoute if the robot does not fit,
    or has arrived before it moves."""
    if (apart := math.dist(start, target)) < NEAREST_TARGET:
        raise NoRoute(
            f"Start and target are {apart:.2f} m apart: the robot would have arrived before it moves. Put them farther apart, "
            "or give the map a larger scale."
        )
    fits = grid.widest_passage(start, target)
    if fits <= radius:
        raise NoRoute(
            f"There is no path from ({start[0]:.2f}, {start[1]:.2f}) to ({target[0]:.2f}, {target[1]:.2f}) for a robot that needs "
            f"{2 * radius:.2f} m: its widest way is {2 * fits:.2f} m wide. Open the wall there, or give the map a larger scale."
        )
    # Start and target may lie close to a wall: that is no passage.
    out, back = (_away_from_walls(grid, grid.cell_at(*place), OPEN) for place in (start, target))
    width = grid.widest_passage(grid.cell_center(out[-1]), grid.cell_center(back[-1]))
    between = _shortest(grid.clearance > max(width - 1e-9, 0.75 * grid.cell_size), out[-1], back[-1])
    narrow = min(between, key=lambda cell: grid.clearance[cell])
    return Route(
        tuple(grid.cell_center(cell) for cell in (*out[:-1], *between, *back[-2::-1])),
        grid.cell_center(narrow),
        2 * float(grid.clearance[narrow]),
    )


def clear_of_walls(
    grid: OccupancyGrid, place: Point, distance: float = 1.25 * ROBOT_RADIUS
) -> tuple[Point, ...]:
    """The way from a place to where the walls are ``distance`` away [m], or as far as it leads straight away from them."""
    cells = _away_from_walls(grid, grid.cell_at(*place), distance)
    return (place, *map(grid.cell_center, cells[1:]))


def check_closed(grid: OccupancyGrid, start: Point, radius: float = ROBOT_RADIUS) -> None:
    """Raises NoRoute if a robot gets from the start to the outside of all walls."""
    reached = grid.reached_from(*start, 2 * radius)
    rows, columns = np.nonzero(reached)
    low, high = grid.walls.reshape(-1, 2).min(axis=0), grid.walls.reshape(-1, 2).max(axis=0)
    x, y = grid.x[columns], grid.y[rows]
    outside = (x < low[0]) | (x > high[0]) | (y < low[1]) | (y > high[1])
    if outside.any():
        first = int(np.flatnonzero(outside)[np.hypot(x[outside] - start[0], y[outside] - start[1]).argmin()])
        raise NoRoute(
            f"The outer wall is open: a robot can leave the drawing at ({x[first]:.2f}, {y[first]:.2f}). Close the wall "
            "all round."
        )


def _away_from_walls(grid: OccupancyGrid, cell: Cell, distance: float) -> list[Cell]:
    """The cells from this one to where the walls are ``distance`` away [m], or as far as they get straight away from them."""
    cells = [cell]
    while grid.clearance[cells[-1]] < distance:
        best = max(_around(grid.shape, cells[-1]), key=lambda other: grid.clearance[other])
        if grid.clearance[best] <= grid.clearance[cells[-1]] + 1e-9:
            break
        cells.append(best)
    return cells


def farthest_apart(
    grid: OccupancyGrid, known: Point | None = None, radius: float = ROBOT_RADIUS
) -> tuple[Point, Point]:
    """Two places that are far apart for a robot of that radius, with room around both: the first is ``known``, where there
    is one. Raises NoRoute."""
    roomy = grid.inside & (grid.clearance > 1.5 * radius)
    if not roomy.any():
        raise NoRoute(f"A robot that needs {2 * radius:.2f} m does not fit anywhere. Use a larger scale.")
    free = grid.inside & (grid.clearance > radius)
    cells: list[Cell] = [(row, column) for row, column in np.argwhere(roomy).tolist()]
    if known is None:
        begin = _last_reached(free, roomy, max(cells, key=lambda cell: grid.clearance[cell]))
        known = grid.cell_center(_away_from_walls(grid, begin, ROOM)[-1])
    else:
        begin = grid.cell_at(*known)
    end = _last_reached(free, roomy, begin)
    return known, grid.cell_center(_away_from_walls(grid, end, ROOM)[-1])


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


def _around(shape: tuple[int, ...], cell: Cell) -> list[Cell]:
    """The neighbours and those across the corners: out of a corner the way away from both walls is slanting."""
    row, column = cell
    return [
        (r, c)
        for r in range(max(0, row - 1), min(shape[0], row + 2))
        for c in range(max(0, column - 1), min(shape[1], column + 2))
    ]


def _neighbours(shape: tuple[int, ...], cell: Cell) -> list[Cell]:
    row, column = cell
    found = [(row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)]
    return [(r, c) for r, c in found if 0 <= r < shape[0] and 0 <= c < shape[1]]
