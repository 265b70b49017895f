"""Laser scans of the walls and footprints at their present poses, and footprint outlines for display."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kit.geometry import Pose
from kit.kernels import kernels
from kit.kernels.arrays import Beams, Shapes, WallBlocks
from kit.kernels.lidar_index import make_wall_blocks
from kit.sim.bodies import PhysicalBody, RigidBody
from kit.sim.physics import Physics
from kit.sim.state import FootprintOutline, LatestScan
from kit.world.records import Circle

ALL_BITS = -1
"""All bits."""


@dataclass(frozen=True, slots=True)
class _VisibleShapes:
    """Every footprint that a laser could see: in the frames of its body, and in the world."""

    bodies: tuple[RigidBody, ...]
    poses: NDArray[np.float64]
    """(rigids, 3) ``x y theta``."""
    pose_numbers: memoryview[Any]
    """The same numbers in a row: numpy takes ten times as long to store one."""
    circle_body: NDArray[np.int64]
    corner_body: NDArray[np.int64]
    local: Shapes
    world: Shapes


class LaserScene:
    """Scans the walls and bodies of a ``Physics`` at their present poses."""

    def __init__(self, physics: Physics) -> None:
        self._physics = physics
        self._shapes_version = self._poses_version = -1
        self._walls_by_bits: dict[tuple[int, int], WallBlocks] = {}
        self._visible_shapes: _VisibleShapes
        """Set by the first scan, which also loads the kernels: a world can be shown before that."""
        self._scan: Callable[..., None] | None = None
        self._place_shapes: Callable[..., None] | None = None
        self._latest: dict[tuple[str, str], LatestScan] = {}

    def scan(
        self, pose: Pose, beams: Beams, max_range: float, bits: int, also_bits: int = ALL_BITS
    ) -> NDArray[np.float32]:
        """Distances [m] along the beams of a sensor at ``pose``, (rays,); NaN where nothing is within ``max_range``.

        A scan sees shapes that have one of the layer ``bits`` and one of ``also_bits``, except sensor footprints and
        a footprint around the sensor.
        """
        self._update()
        ranges = np.empty(len(beams.cos), dtype=np.float32)
        shapes = self._visible_shapes.world
        if also_bits != ALL_BITS:
            shapes = shapes._replace(
                circle_bits=np.where(shapes.circle_bits & also_bits, shapes.circle_bits, 0),
                polygon_bits=np.where(shapes.polygon_bits & also_bits, shapes.polygon_bits, 0),
            )
        walls = self._walls_on_layers(bits, also_bits)
        arguments = (pose.x, pose.y, pose.theta), beams, float(max_range), walls, shapes, bits, ranges
        if self._scan is None:  # of the same types for all lasers
            self._scan = kernels.compiled_for(kernels.scan, arguments)
        self._scan(*arguments)
        return ranges

    def keep_latest(self, scan: LatestScan) -> None:
        """Keeps the latest scan of a laser."""
        self._latest[scan.model, scan.plugin] = scan

    @property
    def latest_scans(self) -> tuple[LatestScan, ...]:
        """The latest scan of each laser."""
        return tuple(self._latest.values())

    def forget_model(self, model: str) -> None:
        """Drops the scans of a model that is gone."""
        self._latest = {laser: scan for laser, scan in self._latest.items() if laser[0] != model}

    def _walls_on_layers(self, bits: int, also_bits: int) -> WallBlocks:
        if (bits, also_bits) not in self._walls_by_bits:
            ends = [w.ends for w in self._physics.walls if w.bits & bits and w.bits & also_bits]
            self._walls_by_bits[bits, also_bits] = make_wall_blocks(np.concatenate([np.zeros((0, 4)), *ends]))
        return self._walls_by_bits[bits, also_bits]

    def _update(self) -> None:
        """Catches up with the physics, if anything moved, came or went."""
        if self._poses_version == self._physics.poses_version:
            return
        self._poses_version = self._physics.poses_version
        if self._shapes_version != self._physics.shapes_version:
            self._shapes_version = self._physics.shapes_version
            self._walls_by_bits = {}
            self._visible_shapes = _visible_shapes(self._physics.bodies)
        seen = self._visible_shapes
        numbers = seen.pose_numbers
        for i, rigid in enumerate(seen.bodies):
            numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2] = rigid.pose
        arguments = seen.poses, seen.circle_body, seen.corner_body, seen.local, seen.world
        if self._place_shapes is None:
            self._place_shapes = kernels.compiled_for(kernels.place_shapes, arguments)
        self._place_shapes(*arguments)


def _visible_shapes(bodies: Iterable[PhysicalBody]) -> _VisibleShapes:
    rigids: dict[RigidBody, int] = {}
    circles, circle_rigid, circle_bits = [], [], []
    corners, corner_rigid, polygon_bits, starts = [], [], [], [0]
    for body in bodies:
        for footprint in body.description.footprints:
            if footprint.sensor or not footprint.category:
                continue
            rigid = rigids.setdefault(body.rigid, len(rigids))
            if isinstance(footprint.shape, Circle):
                circles.append(
                    (*body.offset.transform_point(*footprint.shape.center), footprint.shape.radius)
                )
                circle_rigid.append(rigid)
                circle_bits.append(footprint.category)
            else:
                corners += [body.offset.transform_point(*corner) for corner in footprint.shape.points]
                corner_rigid += [rigid] * len(footprint.shape.points)
                polygon_bits.append(footprint.category)
                starts.append(len(corners))
    local = Shapes(
        np.array(circles, dtype=np.float64).reshape(-1, 3),
        np.array(circle_bits, dtype=np.int64),
        np.array(corners, dtype=np.float64).reshape(-1, 2),
        np.array(starts, dtype=np.int64),
        np.array(polygon_bits, dtype=np.int64),
    )
    world = local._replace(circles=local.circles.copy(), corners=local.corners.copy())
    poses = np.zeros((len(rigids), 3))
    return _VisibleShapes(
        tuple(rigids),
        poses,
        poses.reshape(-1).data,
        np.array(circle_rigid, dtype=np.int64),
        np.array(corner_rigid, dtype=np.int64),
        local,
        world,
    )


def footprint_outlines(bodies: Iterable[PhysicalBody]) -> tuple[FootprintOutline, ...]:
    """Every footprint as it lies in the world."""
    found = []
    for body in bodies:
        pose, description = body.pose, body.description
        for footprint in description.footprints:
            shape = footprint.shape
            if isinstance(shape, Circle):
                (x, y), radius = shape.center, shape.radius
                local: tuple[tuple[float, float], ...] = ((x, y), (x + radius, y))
            else:
                local, radius = shape.points, 0.0
            points = tuple(pose.transform_point(*point) for point in local)
            found.append(
                FootprintOutline(body.model, body.name, description.color, points, radius, footprint.sensor)
            )
    return tuple(found)


def hull_distance(bodies: Iterable[PhysicalBody], point: tuple[float, float]) -> float:
    """From a point of the world to the nearest footprint [m]; 0 inside, infinite where there are none."""
    nearest = math.inf
    for body in bodies:
        x, y, _ = body.pose.relative(Pose(*point))
        for footprint in body.description.footprints:
            shape = footprint.shape
            if isinstance(shape, Circle):
                away = max(0.0, math.hypot(x - shape.center[0], y - shape.center[1]) - shape.radius)
            else:
                away = kernels.point_polygon_distance(x, y, np.array(shape.points))
            nearest = min(nearest, away)
    return nearest
