"""How far it is to a target from everywhere on a map, along ways that keep clear of walls."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from kit.arrays import Float32Array, FloatArray
from kit.fields.occupancy_grid import wall_distances
from kit.kernels import grids
from kit.learning.maps.batch_map import BatchMap, UnsupportedWorld

CELL = 0.025
"""Side of the cells of a distance field [m]."""
CLEARANCE = 0.13
"""Nearer to a wall than this [m] a metre counts for more: the reach of the robot's hull."""
WALL_PRICE = 4.0
"""Cost of one metre along a wall, in metres."""
MAX_CELLS = 10_000_000
"""Of a distance field: those of 100 m by 60 m take nearly a gigabyte while it is computed."""
NEIGHBOURS = tuple((dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy)


class DistanceField(NamedTuple):
    """Lengths of ways, at the middles of square cells."""

    values: Float32Array
    """(rows, columns) [m]"""
    origin: tuple[float, float]
    """The middle of the first cell."""


@cache
def compute_distance_field(
    batch_map: BatchMap,
    target: tuple[float, float],
    clearance: float = CLEARANCE,
    wall_price: float = WALL_PRICE,
) -> DistanceField:
    """The length of the way to ``target`` from everywhere on the map, keeping ``clearance`` [m] of walls where it can.

    Bellman's equation on a grid with eight neighbours, iterated to its fixed point; a step counts for its length
    times the mean price of its ends. Raises UnsupportedWorld where the map and the target together are too large.
    """
    points = np.concatenate([batch_map.walls.reshape(-1, 2), np.array([target])])
    origin = points.min(axis=0) - 2 * CELL
    columns, rows = np.ceil((points.max(axis=0) + 2 * CELL - origin) / CELL).astype(int) + 1
    if int(columns) * int(rows) > MAX_CELLS:
        raise UnsupportedWorld(
            f"the way to the target ({target[0]:g}, {target[1]:g}) is looked for on {columns * CELL:.3g} m x {rows * CELL:.3g} m: "
            f"at most {MAX_CELLS * CELL**2:g} m² are possible. Is it on the map?"
        )
    x, y = origin[0] + CELL * np.arange(columns), origin[1] + CELL * np.arange(rows)
    room = wall_distances(x, y, batch_map.walls, clearance)
    price = 1.0 + (wall_price - 1.0) * np.maximum(0.0, 1.0 - room / clearance)
    # A way from cell to cell cannot slip through a wall when the cells that a wall comes so near are blocked.
    price[room < CELL / math.sqrt(2)] = math.inf
    lengths = np.full((rows, columns), math.inf)
    start = round((target[1] - origin[1]) / CELL), round((target[0] - origin[0]) / CELL)
    lengths[start] = 0.0
    grids.relax_path_lengths(lengths, price, CELL)
    return DistanceField(
        _extrapolate_into_walls(lengths).astype(np.float32), (float(origin[0]), float(origin[1]))
    )


def _extrapolate_into_walls(lengths: FloatArray) -> FloatArray:
    """Cells beside walls take their neighbours' lengths, so that one can interpolate there; others the greatest."""
    rows, columns = lengths.shape
    for _ in range(4):
        padded = np.pad(lengths, 1, constant_values=math.inf)
        around = [padded[1 + dy : 1 + dy + rows, 1 + dx : 1 + dx + columns] for dx, dy in NEIGHBOURS]
        lengths = np.where(np.isinf(lengths), np.min(around, axis=0) + WALL_PRICE * CELL, lengths)
    finite = np.isfinite(lengths)
    return np.where(finite, lengths, lengths[finite].max())
