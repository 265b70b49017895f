"""The free floor of a map as a grid: how far every place is from the walls, and what can be reached."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from kit.world.catalogue import allowed_root_of
from kit.world.loading import load_world
from kit.world.records import World

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
Cell = tuple[int, int]
"""Row and column."""

CELL_SIZE: Final = 0.025
"""Side of a cell [m], on maps that are not too large for it."""
MAX_CELLS: Final = 120_000
MARGIN: Final = 0.1
"""So much [m] around the walls belongs to the grid."""
MAX_CLEARANCE: Final = 0.6
"""Walls farther than this [m] are all alike: nothing that drives here is so large."""


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid:
    """Square cells; ``clearance[row, column]`` [m] is from a cell's middle to the nearest wall, at most FAR."""

    walls: FloatArray
    """(n, 4) ``x1 y1 x2 y2`` [m]"""
    origin: tuple[float, float]
    """The middle of the first cell."""
    cell_size: float
    clearance: FloatArray
    inside: BoolArray
    """(rows, columns): where something thin gets to from where the models stand."""

    @classmethod
    def from_walls(cls, walls: FloatArray, starts: Iterable[tuple[float, float]]) -> OccupancyGrid:
        """The floor between walls (n, 4), n > 0, on which ``starts`` lie."""
        ends = walls.reshape(-1, 2)
        low, high = ends.min(axis=0) - MARGIN, ends.max(axis=0) + MARGIN
        width, height = (high - low).tolist()
        cell = max(CELL_SIZE, math.sqrt(width * height / MAX_CELLS))
        shape = math.ceil(height / cell) + 1, math.ceil(width / cell) + 1
        clearance = np.full(shape, MAX_CLEARANCE)
        x, y = low[0] + cell * np.arange(shape[1]), low[1] + cell * np.arange(shape[0])
        for ax, ay, bx, by in walls.tolist():
            columns = _index_range(
                min(ax, bx) - MAX_CLEARANCE, max(ax, bx) + MAX_CLEARANCE, low[0], cell, shape[1]
            )
            rows = _index_range(
                min(ay, by) - MAX_CLEARANCE, max(ay, by) + MAX_CLEARANCE, low[1], cell, shape[0]
            )
            near = clearance[rows, columns]
            np.minimum(near, _segment_distance(x[columns], y[rows], ax, ay, bx, by), out=near)
        grid = cls(walls, (float(low[0]), float(low[1])), cell, clearance, np.zeros(shape, dtype=np.bool_))
        for start in starts:
            if not grid.inside[grid.cell_at(*start)]:
                grid.inside[grid.reachable_from(start, 0.0)] = True
        return grid

    @property
    def shape(self) -> tuple[int, int]:
        rows, columns = self.clearance.shape
        return rows, columns

    @property
    def cell_centers(self) -> FloatArray:
        """(rows, columns, 2): the cells' places."""
        rows, columns = self.shape
        x, y = (
            self.origin[0] + self.cell_size * np.arange(columns),
            self.origin[1] + self.cell_size * np.arange(rows),
        )
        return np.stack(np.meshgrid(x, y), axis=-1)

    def wall_faces(self) -> FloatArray:
        """(m, 4): the walls that have the inside on one of their sides, each once."""
        walls = np.unique(self.walls, axis=0)
        start, along = walls[:, :2], walls[:, 2:] - walls[:, :2]
        length = np.hypot(along[:, 0], along[:, 1])
        walls, start, along = (each[length > 0] for each in (walls, start, along))
        aside = (
            1.5 * self.cell_size * np.stack((-along[:, 1], along[:, 0]), axis=-1) / length[length > 0, None]
        )
        shares = np.linspace(0.1, 0.9, 9)[:, None, None]
        middle = start + shares * along
        places = np.stack((middle + aside, middle - aside))
        cells = np.rint((places - self.origin) / self.cell_size).astype(int)
        rows, columns = self.shape
        inside = self.inside[cells[..., 1].clip(0, rows - 1), cells[..., 0].clip(0, columns - 1)]
        faces: FloatArray = walls[inside.any(axis=(0, 1))]
        return faces

    def cell_at(self, x: float, y: float) -> Cell:
        """The cell that holds a place; the nearest one for a place off the grid."""
        column, row = (x - self.origin[0]) / self.cell_size, (y - self.origin[1]) / self.cell_size
        return (
            min(max(round(row), 0), self.clearance.shape[0] - 1),
            min(max(round(column), 0), self.clearance.shape[1] - 1),
        )

    def cell_center(self, cell: Cell) -> tuple[float, float]:
        return self.origin[0] + self.cell_size * cell[1], self.origin[1] + self.cell_size * cell[0]

    def reachable_from(self, start: tuple[float, float], radius: float) -> BoolArray:
        """(rows, columns): where a disc of that radius [m] gets to from ``start``."""
        # Nothing slips through a wall where cells that it crosses are blocked.
        free = self.clearance > max(radius, self.cell_size * 0.75)
        # One number for each cell, and a border that is not free: this loop visits 100,000 cells.
        width = free.shape[1] + 2
        ahead = bytearray(np.pad(free, 1).tobytes())
        row, column = self.cell_at(*start)
        first = (row + 1) * width + column + 1
        waiting = [first] if ahead[first] else []
        ahead[first] = False
        while waiting:
            cell = waiting.pop()
            for beside in (cell + width, cell - width, cell + 1, cell - 1):
                if ahead[beside]:
                    ahead[beside] = False
                    waiting.append(beside)
        left = np.frombuffer(ahead, dtype=np.bool_).reshape(-1, width)
        been: BoolArray = free & ~left[1:-1, 1:-1]
        return been

    def widest_passage(self, start: tuple[float, float], goal: tuple[float, float]) -> float:
        """The radius [m] of the largest disc that gets from start to goal; 0 if not even the smallest does."""
        low, high = 0.0, MAX_CLEARANCE
        for _ in range(8):
            middle = 0.5 * (low + high)
            if self.reachable_from(start, middle)[self.cell_at(*goal)]:
                low = middle
            else:
                high = middle
        return low if low > self.cell_size else 0.0


def load_occupancy_grid(world_file: Path) -> tuple[World, OccupancyGrid]:
    """A world with its floor. Raises WorldError, and ValueError if it has no walls."""
    world = load_world(world_file, root=allowed_root_of(world_file))
    return world, occupancy_grid_of(world)


def occupancy_grid_of(world: World) -> OccupancyGrid:
    """Raises ValueError if the world has no walls."""
    walls = [layer.walls.segments for layer in world.layers if layer.walls is not None]
    if not walls or not sum(map(len, walls)):
        raise ValueError(f"{world.file}: a world without walls has no floor to drive on.")
    return OccupancyGrid.from_walls(
        np.concatenate(walls), [(model.pose.x, model.pose.y) for model in world.models]
    )


def wall_depth(grid: OccupancyGrid, faces: FloatArray, x: float, y: float) -> float:
    """How far [m] a place lies behind the nearest of the floor's ``wall_faces``; 0 before it, or on it."""
    if grid.inside[grid.cell_at(x, y)] or not len(faces):
        return 0.0
    ax, ay, bx, by = faces.T
    dx, dy = bx - ax, by - ay
    share = np.clip(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
    away_x, away_y = x - ax - share * dx, y - ay - share * dy
    distance = np.hypot(away_x, away_y)
    nearest = int(distance.argmin())
    depth = float(distance[nearest])
    if depth < 1e-9:
        return 0.0
    beyond = 1.5 * grid.cell_size / depth
    before = (
        x + (beyond - 1.0) * float(away_x[nearest]),
        y + (beyond - 1.0) * float(away_y[nearest]),
    )
    return 0.0 if grid.inside[grid.cell_at(*before)] else depth


def _index_range(low: float, high: float, origin: float, cell: float, count: int) -> slice:
    return slice(max(0, math.floor((low - origin) / cell)), min(count, math.ceil((high - origin) / cell) + 1))


def _segment_distance(x: FloatArray, y: FloatArray, ax: float, ay: float, bx: float, by: float) -> FloatArray:
    """(rows, columns): from the grid ``x``, ``y`` to a segment."""
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    right, up = (x - ax)[None, :], (y - ay)[:, None]
    share = np.clip((right * dx + up * dy) / square, 0.0, 1.0) if square else 0.0
    return np.hypot(right - share * dx, up - share * dy)
