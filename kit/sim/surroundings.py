"""What lasers see, and what a face draws: walls and footprints where they are now."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kit.geometry import Pose
from kit.kernels import kernels
from kit.kernels.lidar_index import in_blocks
from kit.sim.bodies import PhysicalBody, Rigid
from kit.sim.physics import Physics
from kit.world.records import Circle, Color

EVERYTHING = -1
"""All bits."""


@dataclass(frozen=True, slots=True)
class Outline:
    """One footprint as it lies in the world."""

    model: str
    body: str
    color: Color
    points: tuple[tuple[float, float], ...]
    """The corners of a polygon [m]; the centre of a circle, then the point of its rim ahead of the body."""
    radius: float
    """[m], 0 for a polygon."""
    sensor: bool


@dataclass(frozen=True, slots=True, eq=False)
class ScanView:
    """What a laser saw when it last looked."""

    model: str
    plugin: str
    pose: Pose
    """The sensor's, in the world."""
    beams: kernels.Beams
    """The directions of its rays, in its own frame."""
    ranges: NDArray[np.float32]
    """(rays,) [m], noise included, NaN where nothing is in range."""

    @property
    def hits(self) -> NDArray[np.float64]:
        """(hits, 2) ``x y`` in the world [m]."""
        seen = ~np.isnan(self.ranges)
        ranges, cos, sin = self.ranges[seen], self.beams.cos[seen], self.beams.sin[seen]
        turn = np.exp(1j * self.pose.theta)
        ends = ranges * (cos + 1j * sin) * turn + complex(self.pose.x, self.pose.y)
        return np.column_stack([ends.real, ends.imag])


@dataclass(frozen=True, slots=True)
class _Visible:
    """Every footprint that a laser could see: in the frames of the bodies that carry them, and in the world."""

    rigids: tuple[Rigid, ...]
    poses: NDArray[np.float64]
    """(rigids, 3) ``x y theta``."""
    circle_rigid: NDArray[np.int64]
    corner_rigid: NDArray[np.int64]
    local: kernels.Shapes
    world: kernels.Shapes


class Surroundings:
    """Looks at the walls and bodies of a ``Physics`` as they are now."""

    def __init__(self, physics: Physics) -> None:
        self._physics = physics
        self._cast = self._version = -1
        self._walls: dict[tuple[int, int], kernels.Segments] = {}
        self._visible = _visible(())
        self.views: dict[tuple[str, str], ScanView] = {}
        """The last scan of each laser, by model and plugin."""

    def scan(
        self, pose: Pose, beams: kernels.Beams, reach: float, bits: int, among: int = EVERYTHING
    ) -> NDArray[np.float32]:
        """Distances [m] along the beams of a sensor at ``pose``, (rays,); NaN where nothing is within ``reach``.

        Seen is what carries one of the layer ``bits`` and one of ``among``, but for sensor footprints and for
        a footprint around the sensor.
        """
        self._refresh()
        ranges = np.empty(len(beams.cos), dtype=np.float32)
        shapes = self._visible.world
        if among != EVERYTHING:
            shapes = shapes._replace(
                circle_bits=np.where(shapes.circle_bits & among, shapes.circle_bits, 0),
                polygon_bits=np.where(shapes.polygon_bits & among, shapes.polygon_bits, 0),
            )
        kernels.scan(
            (pose.x, pose.y, pose.theta), beams, reach, self._walls_with(bits, among), shapes, bits, ranges
        )
        return ranges

    def forget(self, model: str) -> None:
        """Drops the views of a model that is gone."""
        self.views = {key: view for key, view in self.views.items() if view.model != model}

    def _walls_with(self, bits: int, among: int) -> kernels.Segments:
        if (bits, among) not in self._walls:
            ends = [w.ends for w in self._physics.walls if w.bits & bits and w.bits & among]
            self._walls[bits, among] = in_blocks(np.concatenate([np.zeros((0, 4)), *ends]))
        return self._walls[bits, among]

    def _refresh(self) -> None:
        """Catches up with the physics, if anything moved, came or went."""
        if self._version == self._physics.version:
            return
        self._version = self._physics.version
        if self._cast != self._physics.cast:
            self._cast = self._physics.cast
            self._walls = {}
            self._visible = _visible(self._physics.bodies)
        seen = self._visible
        for i, rigid in enumerate(seen.rigids):
            seen.poses[i] = rigid.pose
        kernels.place_shapes(seen.poses, seen.circle_rigid, seen.corner_rigid, seen.local, seen.world)


def _visible(bodies: Iterable[PhysicalBody]) -> _Visible:
    rigids: dict[Rigid, int] = {}
    circles, circle_rigid, circle_bits = [], [], []
    corners, corner_rigid, polygon_bits, starts = [], [], [], [0]
    for body in bodies:
        for footprint in body.description.footprints:
            if footprint.sensor or not footprint.category:
                continue
            rigid = rigids.setdefault(body.rigid, len(rigids))
            if isinstance(footprint.shape, Circle):
                circles.append((*body.offset.point(*footprint.shape.center), footprint.shape.radius))
                circle_rigid.append(rigid)
                circle_bits.append(footprint.category)
            else:
                corners += [body.offset.point(*corner) for corner in footprint.shape.points]
                corner_rigid += [rigid] * len(footprint.shape.points)
                polygon_bits.append(footprint.category)
                starts.append(len(corners))
    local = kernels.Shapes(
        np.array(circles, dtype=np.float64).reshape(-1, 3),
        np.array(circle_bits, dtype=np.int64),
        np.array(corners, dtype=np.float64).reshape(-1, 2),
        np.array(starts, dtype=np.int64),
        np.array(polygon_bits, dtype=np.int64),
    )
    world = local._replace(circles=local.circles.copy(), corners=local.corners.copy())
    return _Visible(
        tuple(rigids),
        np.zeros((len(rigids), 3)),
        np.array(circle_rigid, dtype=np.int64),
        np.array(corner_rigid, dtype=np.int64),
        local,
        world,
    )


def outlines(bodies: Iterable[PhysicalBody]) -> tuple[Outline, ...]:
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
            points = tuple(pose.point(*point) for point in local)
            found.append(Outline(body.model, body.name, description.color, points, radius, footprint.sensor))
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
                away = kernels.point_polygon(x, y, np.array(shape.points))
            nearest = min(nearest, away)
    return nearest
