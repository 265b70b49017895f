"""The floor of a converted world on which robots have room."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.fields.occupancy_grid import ClearanceGrid, wall_distances
from kit.learning.maps.batch_map import BatchMap
from kit.learning.maps.wall_culling import find_rings, is_inside

FLOOR_CELL = 0.05
"""Side of the floor's square cells [m]."""
MARGIN = 0.6
"""Distances to walls are known up to here [m]."""


@cache
def measure_floor(batch_map: BatchMap) -> ClearanceGrid:
    """The floor within a map's walls."""
    points = np.concatenate([batch_map.walls.reshape(-1, 2), [[each.x, each.y] for each in batch_map.starts]])
    low, high = points.min(axis=0), points.max(axis=0)
    origin = low + 0.5 * FLOOR_CELL
    columns, rows = np.maximum(1, np.ceil((high - low) / FLOOR_CELL)).astype(int)
    x, y = origin[0] + FLOOR_CELL * np.arange(columns), origin[1] + FLOOR_CELL * np.arange(rows)
    room = np.minimum(wall_distances(x, y, batch_map.walls, MARGIN), MARGIN)
    return ClearanceGrid((float(origin[0]), float(origin[1])), FLOOR_CELL, room)


def are_on_floor(batch_map: BatchMap, points: FloatArray) -> BoolArray:
    """(n,) which of the points (n, 2) [m] lie on the floor that closed walls surround, and not within a pillar; all of them
    where the robot's place in the world is not surrounded."""
    rings, place = list(find_rings(batch_map.walls)), np.array([batch_map.starts[0][:2]])
    if not any(is_inside(place, batch_map.walls[ring])[0] for ring in rings):
        return np.ones(len(points), dtype=np.bool_)
    return is_inside(points, batch_map.walls[np.concatenate(rings)])


def hull_radius(batch_map: BatchMap) -> float:
    """How far the farthest point of a robot lies from its origin [m]."""
    return max(math.hypot(x, y) for part in batch_map.robot.hull for x, y in part)


def hull_width(batch_map: BatchMap) -> float:
    """The width of the narrowest passage for a robot [m]: the shorter side of the rectangle around its hull."""
    corners = np.array([corner for part in batch_map.robot.hull for corner in part])
    return float(np.ptp(corners, axis=0).min())
