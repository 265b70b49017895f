"""The free floor of a map as a grid: how far every place is from the walls, and what can be reached."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.segments import nearest_on_segments
from kit.world.catalogue import allowed_root_of
from kit.world.loading import load_world
from kit.world.records import World

Cell = tuple[int, int]
"""Row and column."""

CELL_SIZE: Final = 0.025
"""Side of a cell [m], on maps that are not too large for it."""
MAX_CELLS: Final = 120_000
MARGIN: Final = 0.1
"""Margin of the grid around the walls [m]."""
MAX_CLEARANCE: Final = 0.6
"""Walls farther than this [m] are all alike: nothing that drives here is so large."""


@dataclass(frozen=True, slots=True, eq=False)
class ClearanceGrid:
    """Square cells with their distances to the nearest wall."""

    origin: tuple[float, float]
    """The middle of the first cell [m]."""
    cell_size: float
    """Side of a cell [m]."""
    clearance: FloatArray
    """(rows, columns): from each cell's middle to the nearest wall [m], up to the largest distance that was measured."""

    @property
    def shape(self) -> tuple[int, int]:
        rows, columns = self.clearance.shape
        return rows, columns

    @property
    def x(self) -> FloatArray:
        """(columns,): the middles of the columns [m]."""
        return self.origin[0] + self.cell_size * np.arange(self.clearance.shape[1], dtype=np.float64)

    @property
    def y(self) -> FloatArray:
        """(rows,): the middles of the rows [m]."""
        return self.origin[1] + self.cell_size * np.arange(self.clearance.shape[0], dtype=np.float64)

    @property
    def cell_centers(self) -> FloatArray:
        """(rows, columns, 2): the cells' middles [m]."""
        return np.stack(np.meshgrid(self.x, self.y), axis=-1)

    def cell_of(self, x: float, y: float) -> Cell | None:
        """The cell that holds a point; None outside the grid."""
        row, column = (
            round((y - self.origin[1]) / self.cell_size),
            round((x - self.origin[0]) / self.cell_size),
        )
        rows, columns = self.shape
        return (row, column) if 0 <= row < rows and 0 <= column < columns else None

    def cell_at(self, x: float, y: float) -> Cell:
        """The cell that holds a place; the nearest one for a place off the grid."""
        column, row = (x - self.origin[0]) / self.cell_size, (y - self.origin[1]) / self.cell_size
        return (
            min(max(round(row), 0), self.clearance.shape[0] - 1),
            min(max(round(column), 0), self.clearance.shape[1] - 1),
        )

    def cell_center(self, cell: Cell) -> tuple[float, float]:
        return self.origin[0] + self.cell_size * cell[1], self.origin[1] + self.cell_size * cell[0]

    def reached_from(self, x: float, y: float, width: float) -> BoolArray:
        """(rows, columns): the cells that something ``width`` [m] wide may get to from a point; none if it does not fit there."""
        free = self.clearance > 0.5 * width
        return flood_fill(free, self._free_cell_near(free, x, y))

    def _free_cell_near(self, free: BoolArray, x: float, y: float) -> Cell | None:
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

    def area_cells(self, area: tuple[float, float, float, float] | None, allowed: BoolArray) -> FloatArray:
        """(k, 2) the middles of the allowed cells that lie in an area ``x1 y1 x2 y2`` [m]; None: the whole map."""
        inside = allowed.copy()
        if area is not None:
            x1, y1, x2, y2 = area
            inside &= ((self.x >= x1) & (self.x <= x2))[None, :] & ((self.y >= y1) & (self.y <= y2))[:, None]
        rows, columns = np.nonzero(inside)
        return np.stack([self.x[columns], self.y[rows]], axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid(ClearanceGrid):
    """The floor between walls; its clearance is at most MAX_CLEARANCE."""

    walls: FloatArray
    """(n, 4) ``x1 y1 x2 y2`` [m]"""
    inside: BoolArray
    """(rows, columns): where something thin gets to from where the models stand."""

    @classmethod
    def from_walls(
        cls, walls: FloatArray, starts: Iterable[tuple[float, float]], max_cells: int = MAX_CELLS
    ) -> OccupancyGrid:
        """The floor between walls (n, 4), n > 0, on which ``starts`` lie; on large maps of ``max_cells`` larger cells."""
        ends = walls.reshape(-1, 2)
        low, high = ends.min(axis=0) - MARGIN, ends.max(axis=0) + MARGIN
        width, height = (high - low).tolist()
        cell = max(CELL_SIZE, math.sqrt(width * height / max_cells))
        shape = math.ceil(height / cell) + 1, math.ceil(width / cell) + 1
        x, y = low[0] + cell * np.arange(shape[1]), low[1] + cell * np.arange(shape[0])
        clearance = np.minimum(wall_distances(x, y, walls, MAX_CLEARANCE), MAX_CLEARANCE)
        origin = float(low[0]), float(low[1])
        grid = cls(origin, cell, clearance, walls, np.zeros(shape, dtype=np.bool_))
        for start in starts:
            if not grid.inside[grid.cell_at(*start)]:
                grid.inside[grid.reachable_from(start, 0.0)] = True
        return grid

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

    def reachable_from(self, start: tuple[float, float], radius: float) -> BoolArray:
        """(rows, columns): where a disc of that radius [m] gets to from ``start``."""
        # Nothing slips through a wall where cells that it crosses are blocked.
        free = self.clearance > max(radius, self.cell_size * 0.75)
        return flood_fill(free, self.cell_at(*start))

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


def flood_fill(free: BoolArray, start: Cell | None) -> BoolArray:
    """(rows, columns): the free cells that are connected with ``start`` by sides; none if it is None or not free."""
    if start is None or not free[start]:
        return np.zeros_like(free)
    # One number for each cell, and a border that is not free: this loop visits 100,000 cells.
    width = free.shape[1] + 2
    ahead = bytearray(np.pad(free, 1).tobytes())
    first = (start[0] + 1) * width + start[1] + 1
    waiting = [first]
    ahead[first] = False
    while waiting:
        cell = waiting.pop()
        for beside in (cell + width, cell - width, cell + 1, cell - 1):
            if ahead[beside]:
                ahead[beside] = False
                waiting.append(beside)
    left = np.frombuffer(ahead, dtype=np.bool_).reshape(-1, width)
    reached: BoolArray = free & ~left[1:-1, 1:-1]
    return reached


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


def load_occupancy_grid(world_file: Path) -> tuple[World, OccupancyGrid]:
    """A world with its floor. Raises WorldError, and ValueError if it has no walls."""
    world = load_world(world_file, root=allowed_root_of(world_file))
    return world, occupancy_grid_of(world)


def occupancy_grid_of(world: World, max_cells: int = MAX_CELLS) -> OccupancyGrid:
    """The world's floor, of at most about ``max_cells`` cells. Raises ValueError if the world has no walls."""
    walls = world.wall_segments
    if not len(walls):
        raise ValueError(f"{world.file}: the world has no walls, so it has no floor to drive on.")
    return OccupancyGrid.from_walls(
        walls, [(model.pose.x, model.pose.y) for model in world.models], max_cells
    )


def wall_depth(grid: OccupancyGrid, faces: FloatArray, x: float, y: float) -> float:
    """How far [m] a place lies behind the nearest of the floor's ``wall_faces``; 0 before it, or on it."""
    if grid.inside[grid.cell_at(x, y)] or not len(faces):
        return 0.0
    ((distances,), (places,)) = nearest_on_segments(np.array([[x, y]]), faces)
    nearest = int(distances.argmin())
    depth = float(distances[nearest])
    if depth < 1e-9:
        return 0.0
    beyond, (face_x, face_y) = 1.5 * grid.cell_size / depth, places[nearest].tolist()
    before = x + (beyond - 1.0) * (x - face_x), y + (beyond - 1.0) * (y - face_y)
    return 0.0 if grid.inside[grid.cell_at(*before)] else depth
