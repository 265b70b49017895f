"""Searches for a path between walls: a flood fill on a grid of cells."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

CELL: Final = 0.02
"""m; larger in a large world."""
MAX_CELLS: Final = 1_000
"""Cells along one side of the grid."""
MARGIN_CELLS: Final = 4
"""Cells around the walls."""


def search_path(
    walls: NDArray[np.float64], start: tuple[float, float], target: tuple[float, float] | None, radius: float
) -> tuple[bool, bool]:
    """Returns (whether a disc of this radius [m] can move from start to target, whether walls enclose it).

    ``walls``: (n, 4) ``x1 y1 x2 y2`` [m]. Without a target the first is False.
    """
    points = np.concatenate([walls.reshape(-1, 2), [start], [] if target is None else [target]], axis=None)
    points = points.reshape(-1, 2)
    low, size = points.min(axis=0) - radius, np.ptp(points, axis=0) + 2 * radius
    cell = max(CELL, float(size.max()) / MAX_CELLS)
    shape = np.ceil(size / cell).astype(int) + 2 * MARGIN_CELLS
    low = low - MARGIN_CELLS * cell
    free = np.ones(tuple(shape), dtype=np.bool_)
    for segment in walls:
        _mark_blocked(free, segment, low, cell, radius)

    def cell_at(point: tuple[float, float]) -> tuple[int, int]:
        column, row = ((np.array(point) - low) / cell).astype(int)
        return int(column), int(row)

    reached = _connected_cells(free, cell_at(start))
    is_open = reached[0].any() or reached[-1].any() or reached[:, 0].any() or reached[:, -1].any()
    return target is not None and bool(reached[cell_at(target)]), bool(reached.any() and not is_open)


def _mark_blocked(
    free: NDArray[np.bool_],
    segment: NDArray[np.float64],
    low: NDArray[np.float64],
    cell: float,
    radius: float,
) -> None:
    """Marks the cells whose centres are nearer to a wall than the radius."""
    a, b = segment[:2] - low, segment[2:] - low
    first = np.maximum(np.floor((np.minimum(a, b) - radius) / cell).astype(int) - 1, 0)
    last = np.minimum(np.ceil((np.maximum(a, b) + radius) / cell).astype(int) + 1, free.shape)
    xs = (np.arange(first[0], last[0]) + 0.5) * cell
    ys = (np.arange(first[1], last[1]) + 0.5) * cell
    along, length = b - a, math.dist(a, b)
    x, y = xs[:, None] - a[0], ys[None, :] - a[1]
    part = np.clip((x * along[0] + y * along[1]) / max(length * length, 1e-12), 0.0, 1.0)
    near = np.hypot(x - part * along[0], y - part * along[1]) < max(radius, cell)
    free[first[0] : last[0], first[1] : last[1]] &= ~near


def _connected_cells(free: NDArray[np.bool_], start: tuple[int, int]) -> NDArray[np.bool_]:
    """Returns the free cells that are connected with the start."""
    reached = np.zeros_like(free)
    reached[start] = free[start]
    frontier = reached.copy()
    while frontier.any():
        grown = np.zeros_like(free)
        grown[1:] |= frontier[:-1]
        grown[:-1] |= frontier[1:]
        grown[:, 1:] |= frontier[:, :-1]
        grown[:, :-1] |= frontier[:, 1:]
        frontier = grown & free & ~reached
        reached |= frontier
    return reached
