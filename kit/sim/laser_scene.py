"""Laser scans of the walls and footprints at their present poses, and footprint outlines for display."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from kit.arrays import Float32Array
from kit.geometry import Pose
from kit.kernels import kernels
from kit.kernels.arrays import Beams, MovingShapes, Shapes, WallBlocks
from kit.kernels.lidar_index import make_wall_blocks
from kit.sim.bodies import PhysicalBody, RigidBody
from kit.sim.physics import Physics
from kit.sim.state import FootprintOutline, LatestScan
from kit.world.records import Circle

ALL_BITS = -1
"""All bits."""

_KeptScan = tuple[Pose, Beams, Float32Array, float]
"""A scan's fields, without those that name its laser."""
NO_NOISE = 0.0, 0, 0


class VisibleShapes:
    """The footprints that lasers of some layers can see: in the frames of their bodies, and in the world."""

    def __init__(self, bodies: Iterable[PhysicalBody], bits: int, also_bits: int) -> None:
        rigids: dict[RigidBody, int] = {}
        circles, circle_rigid, circle_bits = [], [], []
        corners, corner_rigid, polygon_bits, starts = [], [], [], [0]
        for body in bodies:
            for footprint in body.description.footprints:
                seen = footprint.category & bits if footprint.category & also_bits else 0
                if footprint.sensor or not seen:
                    continue
                rigid = rigids.setdefault(body.rigid, len(rigids))
                if isinstance(footprint.shape, Circle):
                    circles.append(
                        (*body.offset.transform_point(*footprint.shape.center), footprint.shape.radius)
                    )
                    circle_rigid.append(rigid)
                    circle_bits.append(seen)
                else:
                    corners += [body.offset.transform_point(*corner) for corner in footprint.shape.points]
                    corner_rigid += [rigid] * len(footprint.shape.points)
                    polygon_bits.append(seen)
                    starts.append(len(corners))
        self._bodies = tuple(rigids)
        self._placed: list[Pose | None] = [None] * len(rigids)
        self._poses = np.zeros((len(rigids), 3))  # x y theta
        self._numbers = self._poses.reshape(-1).data  # the same: numpy takes ten times as long to store one
        world = Shapes(
            np.array(circles, dtype=np.float64).reshape(-1, 3),
            np.array(circle_bits, dtype=np.int64),
            np.array(corners, dtype=np.float64).reshape(-1, 2),
            np.array(starts, dtype=np.int64),
            np.array(polygon_bits, dtype=np.int64),
        )
        self.shapes = MovingShapes(
            self._poses,
            np.array(circle_rigid, dtype=np.int64),
            np.array(corner_rigid, dtype=np.int64),
            world.circles.copy(),
            world.corners.copy(),
            world,
        )

    def update_poses(self) -> bool:
        """Takes over the bodies' poses; returns whether one has moved since the last time."""
        has_moved = False
        for i, rigid in enumerate(self._bodies):
            pose = rigid.pose
            if pose is not self._placed[i]:  # a body has the same record of its pose until it moves
                self._placed[i], has_moved = pose, True
                self._numbers[3 * i : 3 * i + 3] = array("d", pose)
        return has_moved


class LaserScene:
    """The walls and bodies of a ``Physics`` as lasers see them, and the latest scan of each laser."""

    def __init__(self, physics: Physics) -> None:
        self.physics = physics
        self._shapes_version = -1
        self._layers: dict[tuple[int, int], tuple[WallBlocks, VisibleShapes]] = {}
        self._latest: dict[tuple[str, str], LatestScan | _KeptScan] = {}

    def visible(self, bits: int, also_bits: int) -> tuple[WallBlocks, VisibleShapes]:
        """The walls and footprints that these layers have in common."""
        physics = self.physics
        if self._shapes_version != physics.shapes_version:
            self._shapes_version, self._layers = physics.shapes_version, {}
        seen = self._layers.get((bits, also_bits))
        if seen is None:
            ends = [w.ends for w in physics.walls if w.bits & bits and w.bits & also_bits]
            walls = make_wall_blocks(np.concatenate([np.zeros((0, 4)), *ends]))
            seen = self._layers[bits, also_bits] = walls, VisibleShapes(physics.bodies, bits, also_bits)
        return seen

    def keep_latest(
        self,
        laser: tuple[str, str],
        pose: Pose,
        beams: Beams,
        ranges: Float32Array,
        max_range: float,
    ) -> None:
        """Keeps the latest scan of a laser, named by its model and plugin."""
        self._latest[laser] = pose, beams, ranges, max_range

    @property
    def latest_scans(self) -> tuple[LatestScan, ...]:
        """The latest scan of each laser."""
        for laser, kept in self._latest.items():
            if not isinstance(kept, LatestScan):  # made only when somebody looks, and once
                self._latest[laser] = LatestScan(laser[0], laser[1], *kept)
        return tuple(scan for scan in self._latest.values() if isinstance(scan, LatestScan))

    def forget_model(self, model: str) -> None:
        """Drops the scans of a model that is gone."""
        self._latest = {laser: scan for laser, scan in self._latest.items() if laser[0] != model}


class Scanner:
    """Scans a scene along the same beams again and again."""

    def __init__(
        self, scene: LaserScene, beams: Beams, max_range: float, bits: int, also_bits: int = ALL_BITS
    ) -> None:
        """The laser sees what is within ``max_range`` [m] and has one of the layer ``bits`` and one of ``also_bits``, except sensor
        footprints and a footprint around the sensor."""
        self._scene, self._physics = scene, scene.physics
        self._beams, self._max_range, self._layers = beams, float(max_range), (bits, also_bits)
        self._bits, self._rays = bits, len(beams.cos)
        self._shapes_version = -1
        self._scan: Callable[..., None] | None = None

    def scan(self, pose: Pose, noise: tuple[float, int, int] = NO_NOISE) -> Float32Array:
        """Distances [m] along the beams from ``pose``, (rays,); NaN where nothing is in range. ``noise``: its standard
        deviation [m], its stream and the number of this scan in it."""
        if self._shapes_version != self._physics.shapes_version:
            self._look_up()
        ranges = np.empty(self._rays, dtype=np.float32)
        arguments = (
            self._buffers,
            (*pose,),
            self._beams,
            self._max_range,
            self._walls,
            self._visible.shapes,
            self._visible.update_poses(),
            self._bits,
            noise,
            ranges,
        )
        if self._scan is None:
            self._scan = kernels.compiled_for(kernels.scan_moved, arguments)
        self._scan(*arguments)
        return ranges

    def _look_up(self) -> None:
        self._shapes_version = self._physics.shapes_version
        self._walls, self._visible = self._scene.visible(*self._layers)
        corners = int(np.diff(self._visible.shapes.world.starts).max(initial=0))
        # As Python: it is called once, and its machine code takes longer to load.
        allocate: Any = kernels.allocate_scan_buffers
        self._buffers = allocate.py_func(self._beams.lines, corners)


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
    """Returns the distance from a point of the world to the nearest footprint [m]; 0 inside, infinite where there are none."""
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
