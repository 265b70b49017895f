"""The floor of a map: how far from walls it is everywhere, where a robot fits, and what can be reached from where."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from kit.learning.environment.batch_map import BatchMap
from kit.learning.tasks.episode_places import Area

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

FLOOR_CELL = 0.05
"""Side of the floor's square cells [m]."""
MARGIN = 0.6
"""Distances to walls are known up to here [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class FloorGrid:
    """The cells of a map's floor."""

    origin: tuple[float, float]
    """The middle of the first cell [m]."""
    clearance: FloatArray
    """(rows, columns): from each cell's middle to the nearest wall [m], up to MARGIN."""

    @property
    def x(self) -> FloatArray:
        """(columns,) [m]"""
        return self.origin[0] + FLOOR_CELL * np.arange(self.clearance.shape[1], dtype=np.float64)

    @property
    def y(self) -> FloatArray:
        """(rows,) [m]"""
        return self.origin[1] + FLOOR_CELL * np.arange(self.clearance.shape[0], dtype=np.float64)

    def cell_of(self, x: float, y: float) -> tuple[int, int] | None:
        """The row and column of a point; None outside the map."""
        row, column = round((y - self.origin[1]) / FLOOR_CELL), round((x - self.origin[0]) / FLOOR_CELL)
        rows, columns = self.clearance.shape
        return (row, column) if 0 <= row < rows and 0 <= column < columns else None

    def reached_from(self, x: float, y: float, width: float) -> BoolArray:
        """(rows, columns): the cells that something ``width`` [m] wide may get to from a point; none if it does not fit there."""
        free = self.clearance > 0.5 * width
        reached = np.zeros_like(free)
        start = self._free_cell_near(free, x, y)
        if start is None:
            return reached
        reached[start] = True
        waiting = deque([start])
        rows, columns = free.shape
        while waiting:
            row, column = waiting.popleft()
            for r, c in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
                if 0 <= r < rows and 0 <= c < columns and free[r, c] and not reached[r, c]:
                    reached[r, c] = True
                    waiting.append((r, c))
        return reached

    def _free_cell_near(self, free: BoolArray, x: float, y: float) -> tuple[int, int] | None:
        """The point's cell, or the nearest one beside it: a point may be free where its cell's middle is not quite."""
        cell = self.cell_of(x, y)
        if cell is None:
            return None
        rows, columns = free.shape
        around = [
            (cell[0] + dr, cell[1] + dc)
            for dr in (0, -1, 1)
            for dc in (0, -1, 1)
            if 0 <= cell[0] + dr < rows and 0 <= cell[1] + dc < columns
        ]
        return next((each for each in around if free[each]), None)

    def area_cells(self, area: Area | None, allowed: BoolArray) -> FloatArray:
        """(k, 2) the middles of the allowed cells that lie in an area; None: the whole map."""
        inside = allowed.copy()
        if area is not None:
            x1, y1, x2, y2 = area
            inside &= ((self.x >= x1) & (self.x <= x2))[None, :] & ((self.y >= y1) & (self.y <= y2))[:, None]
        rows, columns = np.nonzero(inside)
        return np.stack([self.x[columns], self.y[rows]], axis=1)


def wall_distances(x: FloatArray, y: FloatArray, walls: FloatArray, most: float) -> FloatArray:
    """(rows, columns): the distance from every point of a grid, at most ``most`` apart from walls (n, 4), to the nearest
    one [m]; infinite farther away."""
    nearest = np.full((len(y), len(x)), math.inf)
    for ax, ay, bx, by in walls.tolist():
        columns = slice(*np.searchsorted(x, (min(ax, bx) - most, max(ax, bx) + most)))
        rows = slice(*np.searchsorted(y, (min(ay, by) - most, max(ay, by) + most)))
        px, py = x[columns][None, :], y[rows][:, None]
        dx, dy = bx - ax, by - ay
        length2 = dx * dx + dy * dy
        along = (px - ax) * dx + (py - ay) * dy
        share = np.clip(along / length2, 0.0, 1.0) if length2 else 0.0 * along
        away = np.hypot((px - ax) - share * dx, (py - ay) - share * dy)
        np.minimum(nearest[rows, columns], away, out=nearest[rows, columns])
    return nearest


@cache
def measure_floor(batch_map: BatchMap) -> FloorGrid:
    """The floor within a map's walls."""
    points = np.concatenate([batch_map.walls.reshape(-1, 2), [[each.x, each.y] for each in batch_map.starts]])
    low, high = points.min(axis=0), points.max(axis=0)
    origin = low + 0.5 * FLOOR_CELL
    columns, rows = np.maximum(1, np.ceil((high - low) / FLOOR_CELL)).astype(int)
    x, y = origin[0] + FLOOR_CELL * np.arange(columns), origin[1] + FLOOR_CELL * np.arange(rows)
    room = np.minimum(wall_distances(x, y, batch_map.walls, MARGIN), MARGIN)
    return FloorGrid((float(origin[0]), float(origin[1])), room)


def hull_radius(batch_map: BatchMap) -> float:
    """How far the farthest point of a robot lies from its origin [m]."""
    return max(math.hypot(x, y) for part in batch_map.robot.hull for x, y in part)


def hull_width(batch_map: BatchMap) -> float:
    """The width of the narrowest passage for a robot [m]: the shorter side of the rectangle around its hull."""
    corners = np.array([corner for part in batch_map.robot.hull for corner in part])
    return float(np.ptp(corners, axis=0).min())
