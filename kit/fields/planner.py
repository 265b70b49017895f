"""Plans a path to the target that keeps clear of walls: least cost over the free floor, then least bending.

The least cost from every cell to the target is a navigation function (Rimon and Koditschek's term; here Dijkstra's
algorithm, Numerische Mathematik 1, 1959): unlike a sum of charges it has no minimum but the target.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from kit.arrays import FloatArray
from kit.fields.occupancy_grid import MAX_CLEARANCE, Cell, OccupancyGrid

COMFORTABLE_ROOM: Final = 0.15
"""More room than this [m] on either side costs nothing less."""
MAX_PRICE: Final = 8.0
"""Cost of a metre without any room, relative to one with all of it."""
POINT_SPACING: Final = 0.03
"""m between the points of a way."""
MAX_POINTS: Final = 600
"""Most points of a path; longer ones have them farther apart."""
SMOOTHING_ROUNDS: Final = 300
"""Iterations of smoothing a path."""
STIFFNESSES: Final = (1500.0, 300.0, 60.0, 8.0)
"""The stiffest way that fits is taken. So stiff a way turns within (stiffness / 0.05) ** 0.25 points or so."""
TENSION: Final = 0.2
WALL_PUSH: Final = 0.02
"""How far walls that are too near push a way in one round [m]."""
STRAIGHT_START_POINTS: Final = 3
"""Number of points of a path straight ahead of its start, if the heading is given."""
END_RADIUS: Final = 0.3
"""Within this distance [m] of its ends, a path only needs to fit the robot's length, not its width."""

NEIGHBOURS: Final = tuple(
    (row, column, math.hypot(row, column)) for row in (-1, 0, 1) for column in (-1, 0, 1) if row or column
)


class Unreachable(Exception):
    """No way leads to the target; the message says why, in the user's terms."""


@dataclass(frozen=True, slots=True)
class VehicleSize:
    """Dimensions of the vehicle that the path is planned for."""

    radius: float
    """Radius [m] of the disc that holds it in any direction."""
    min_radius: float
    """Radius [m] of the smallest disc that it needs at the ends of its path: several side by side are less long than
    wide [m]."""
    label: str = "the robot"
    """Its name in messages."""


@dataclass(frozen=True, slots=True, eq=False)
class CostToGo:
    """The least cost to one target from every cell, for something of some size; inf where no way leads."""

    grid: OccupancyGrid
    target: tuple[float, float]
    size: VehicleSize
    cost: FloatArray
    """(rows, columns): metres, dearer ones near walls counted for more."""
    next_cell: NDArray[np.int32]
    """(rows, columns): the number of the next cell on the way; the target's is its own."""

    @classmethod
    def compute(
        cls, grid: OccupancyGrid, target: tuple[float, float], size: VehicleSize, start: tuple[float, float]
    ) -> CostToGo:
        """``start``: where it stands now, and so fits."""
        # One number for each cell, and a border where nothing leads: this loop looks at a million neighbours.
        width = grid.shape[1] + 2
        price = (
            np.pad(_travel_price(grid, size, (start, target)), 1, constant_values=math.inf).ravel().tolist()
        )
        steps = [(down * width + right, 0.5 * length * grid.cell_size) for down, right, length in NEIGHBOURS]
        cost = [math.inf] * len(price)
        after = [-1] * len(price)
        row, column = grid.cell_at(*target)
        first = (row + 1) * width + column + 1
        waiting: list[tuple[float, int]] = []
        if price[first] < math.inf:
            cost[first] = 0.0
            after[first] = first
            waiting.append((0.0, first))
        while waiting:
            so_far, number = heapq.heappop(waiting)
            if so_far > cost[number]:
                continue
            here = price[number]
            for step, half_length in steps:
                beside = number + step
                through = so_far + half_length * (here + price[beside])
                if through < cost[beside]:
                    cost[beside] = through
                    after[beside] = number
                    heapq.heappush(waiting, (through, beside))
        costs, padded = (np.array(each).reshape(-1, width)[1:-1, 1:-1] for each in (cost, after))
        rows, columns = np.divmod(padded, width)
        next_cell = np.where(padded < 0, -1, (rows - 1) * grid.shape[1] + columns - 1).astype(np.int32)
        return cls(grid, target, size, np.ascontiguousarray(costs), next_cell)

    def directions(self) -> FloatArray:
        """(rows, columns, 2): the unit vector from each cell to the next; zero where no way leads on."""
        rows, columns = self.grid.shape
        here = np.arange(rows * columns).reshape(rows, columns)
        there = np.where(self.next_cell >= 0, self.next_cell, here)
        step = np.stack((there % columns - here % columns, there // columns - here // columns), axis=-1)
        length = np.hypot(step[..., 0], step[..., 1])[..., None]
        unit: FloatArray = step / np.where(length > 0, length, 1.0)
        return unit

    def check_reachable(self, start: tuple[float, float]) -> None:
        """Raises Unreachable if no way leads from ``start``, and says where it fails."""
        grid = self.grid
        for place, name in ((self.target, "The target"), (start, "The start")):
            if grid.clearance[grid.cell_at(*place)] < self.size.min_radius - 0.5 * grid.cell_size:
                raise Unreachable(
                    f"{name} ({place[0]:g}, {place[1]:g}) is too close to a wall for {self.size.label}."
                )
        if math.isfinite(self.cost[grid.cell_at(*start)]):
            return
        widest = grid.widest_passage(start, self.target)
        way = f"from ({start[0]:g}, {start[1]:g}) to the target ({self.target[0]:g}, {self.target[1]:g})"
        if widest == 0.0:
            raise Unreachable(f"There is no path {way}: walls block it, or it is inside one.")
        raise Unreachable(
            f"No path {way} is wide enough for {self.size.label}, {2 * self.size.radius:.2f} m wide: "
            f"where it is narrowest, the widest leaves {2 * widest:.2f} m."
        )

    def plan_path(self, start: tuple[float, float], heading: float | None = None) -> FloatArray:
        """(k, 2): a smooth way from ``start`` to the target, evenly spaced; at first along ``heading`` [rad].

        Call ``check_reachable`` first.
        """
        columns = self.grid.shape[1]
        cell = self.grid.cell_at(*start)
        cells: list[Cell] = [cell]
        while (number := int(self.next_cell[cell])) != cell[0] * columns + cell[1]:
            cell = divmod(number, columns)
            cells.append(cell)
        corners = np.array([start, *(self.grid.cell_center(each) for each in cells[1:-1]), self.target])
        spacing = max(POINT_SPACING, float(np.hypot(*np.diff(corners, axis=0).T).sum()) / MAX_POINTS)
        rough = resample_path(corners, spacing)
        if len(rough) <= STRAIGHT_START_POINTS + 2:
            return rough
        fixed = 1
        if heading is not None:
            fixed = STRAIGHT_START_POINTS
            ahead = start + spacing * np.outer(range(fixed), (math.cos(heading), math.sin(heading)))
            rough = np.concatenate((ahead, resample_path(rough[fixed:], spacing)))
        for stiffness in STIFFNESSES:
            way = resample_path(self._smooth_path(rough, fixed, stiffness), spacing)
            if self._has_room(way):
                return way
        return rough

    def _has_room(self, way: FloatArray) -> bool:
        """Whether the whole path keeps the clearance that it was planned with."""
        near_end = np.minimum(*(np.hypot(*(way - way[end]).T) for end in (0, -1))) < END_RADIUS
        needed = np.where(near_end, self.size.min_radius, self.size.radius)
        return bool(
            (
                interpolate_grid(self.grid, self.grid.clearance, way) >= needed - 0.5 * self.grid.cell_size
            ).all()
        )

    def _smooth_path(self, rough: FloatArray, fixed: int, stiffness: float) -> FloatArray:
        """The way as an elastic band: stiffness straightens it, walls that are too near push it away.

        Solved as an active contour (Kass, Witkin and Terzopoulos, 1988): implicit in the band's own forces,
        explicit in the walls'. The first ``fixed`` points and the last one stay.
        """
        way = rough.copy()
        size, free = len(way), slice(fixed, len(way) - 1)
        first, second = (np.diff(np.eye(size), order, axis=0) for order in (1, 2))
        own = TENSION * first.T @ first + stiffness * second.T @ second
        held = np.ones(size, dtype=np.bool_)
        held[free] = False
        inverse = np.linalg.inv(np.eye(size)[free, free] + own[free, free])
        from_held = own[free][:, held] @ way[held]
        wanted = min(self.size.radius + COMFORTABLE_ROOM, MAX_CLEARANCE - self.grid.cell_size)
        along_y, along_x = np.gradient(self.grid.clearance, self.grid.cell_size)
        values = np.stack((self.grid.clearance, along_x, along_y))
        for _ in range(SMOOTHING_ROUNDS):
            some = way[free]
            room, *slopes = interpolate_grid(self.grid, values, some)
            lack = np.clip(1.0 - room / wanted, 0.0, 1.0)
            away = np.column_stack(slopes)
            way[free] = inverse @ (some + WALL_PUSH * lack[:, None] * away - from_held)
        return way


def _travel_price(grid: OccupancyGrid, size: VehicleSize, ends: Iterable[tuple[float, float]]) -> FloatArray:
    """(rows, columns): what a metre costs there; inf where it does not fit."""
    lack = np.clip(1.0 - (grid.clearance - size.radius) / COMFORTABLE_ROOM, 0.0, 1.0)
    price: FloatArray = 1.0 + (MAX_PRICE - 1.0) * lack**2
    needed = np.full(grid.shape, size.radius)
    for end in ends:
        needed[np.hypot(*np.moveaxis(grid.cell_centers - end, -1, 0)) < END_RADIUS] = size.min_radius
    price[(grid.clearance < np.maximum(needed, 0.75 * grid.cell_size)) | ~grid.inside] = math.inf
    return price


def interpolate_grid(grid: OccupancyGrid, values: FloatArray, places: FloatArray) -> FloatArray:
    """(..., k): a grid's values (..., rows, columns) at places (k, 2), between the four nearest cells."""
    rows, columns = values.shape[-2:]
    u = np.clip((places[:, 0] - grid.origin[0]) / grid.cell_size, 0.0, columns - 1.001)
    v = np.clip((places[:, 1] - grid.origin[1]) / grid.cell_size, 0.0, rows - 1.001)
    column, row = u.astype(int), v.astype(int)
    u, v = u - column, v - row
    below = (1 - u) * values[..., row, column] + u * values[..., row, column + 1]
    above = (1 - u) * values[..., row + 1, column] + u * values[..., row + 1, column + 1]
    found: FloatArray = (1 - v) * below + v * above
    return found


def resample_path(way: FloatArray, spacing: float) -> FloatArray:
    """A path with points at even distances, about ``spacing`` [m]; its ends stay."""
    steps = np.hypot(*np.diff(way, axis=0).T)
    kept = np.concatenate(([True], steps > 1e-9))
    way, along = way[kept], np.concatenate(([0.0], np.cumsum(steps[steps > 1e-9])))
    if len(way) < 2:
        return np.repeat(way[:1], 2, axis=0)
    count = max(2, round(along[-1] / spacing) + 1)
    at = np.linspace(0.0, along[-1], count)
    return np.column_stack([np.interp(at, along, way[:, axis]) for axis in (0, 1)])
