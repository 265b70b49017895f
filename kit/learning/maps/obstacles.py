"""Bodies of a world that are neither walls nor robots: carts that move by themselves, and things that stand about."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.geometry import Pose
from kit.kernels.arrays import ObstacleParts
from kit.sim.plugins.tween import MODES, TweenParams
from kit.world.records import Circle, Polygon

TOUCHED, SEEN = 1, 2
"""Bits of a part: robots touch it; their lidars see it."""
MOTION_SAMPLES = 4096
"""A motion is tabulated at this many times of its period, and interpolated between them."""


@dataclass(frozen=True, slots=True)
class ObstaclePart:
    """One shape of an obstacle, in its body's frame."""

    shape: Circle | Polygon
    bits: int


@dataclass(frozen=True, slots=True, eq=False)
class Obstacle:
    """One body."""

    name: str
    """Name of its model."""
    pose: Pose
    """Where it stands, or begins."""
    parts: tuple[ObstaclePart, ...]
    motion: TweenParams | None
    """How it moves; None: it stands."""

    @property
    def period(self) -> float:
        """Seconds after which its motion begins again; where it does not, until it has ended."""
        if self.motion is None:
            return 1.0
        return self.motion.duration * (2.0 if self.motion.progress is MODES["yoyo"] else 1.0)

    @property
    def is_repeating(self) -> bool:
        return self.motion is None or self.motion.progress is not MODES["once"]

    def displacements(self) -> FloatArray:
        """(MOTION_SAMPLES + 1, 3) from its start, over one period, in the world's axes."""
        if self.motion is None or self.motion.progress is None:
            return np.zeros((MOTION_SAMPLES + 1, 3))
        times = np.linspace(0.0, self.period, MOTION_SAMPLES + 1) / self.motion.duration
        shares = [self.motion.easing(self.motion.progress(time)) for time in times.tolist()]
        return np.outer(shares, self.motion.delta)


def phases_of_bodies(phases: FloatArray, count: int) -> FloatArray:
    """(n, count) where on their ways the bodies of worlds begin, 0 to 1, from one number of each world (n).

    The phases of several bodies are as if they had been drawn apart.
    """
    own: FloatArray = np.modf(phases[:, None] * (1.0 + 7919.0 * np.arange(count)))[0]
    return own


class ObstacleMotions:
    """The obstacles of several maps, and where they are at any time."""

    def __init__(self, maps: Sequence[Sequence[Obstacle]]) -> None:
        self.most = max((len(each) for each in maps), default=0)
        """Obstacles of the map that has most."""
        shape = len(maps), self.most
        self._starts = np.zeros((*shape, 3))
        self._periods = np.ones(shape)
        self._repeating = np.ones(shape, dtype=np.bool_)
        self._tables = np.zeros((*shape, MOTION_SAMPLES + 1, 3))
        for number, obstacles in enumerate(maps):
            for place, obstacle in enumerate(obstacles):
                self._starts[number, place] = obstacle.pose
                self._periods[number, place] = obstacle.period
                self._repeating[number, place] = obstacle.is_repeating
                self._tables[number, place] = obstacle.displacements()

    def poses(self, maps: IntArray, times: FloatArray, phases: FloatArray) -> FloatArray:
        """(n, most, 3) where the bodies of the maps (n) are, ``times`` (n) seconds after the start.

        ``phases`` (n): 0 to 1, where on their ways they began.
        """
        if not self.most:
            return np.zeros((len(maps), 0, 3))
        periods, repeating = self._periods[maps], self._repeating[maps]
        passed = times[:, None] + phases_of_bodies(phases, self.most) * periods
        passed = np.where(repeating, np.mod(passed, periods), np.minimum(passed, periods))
        place = passed / periods * MOTION_SAMPLES
        low = np.minimum(place.astype(np.int64), MOTION_SAMPLES - 1)
        share = (place - low)[:, :, None]
        rows = maps[:, None], np.arange(self.most)[None, :]
        moved = (1.0 - share) * self._tables[(*rows, low)] + share * self._tables[(*rows, low + 1)]
        found: FloatArray = self._starts[maps] + moved
        return found


def make_obstacle_parts(maps: Sequence[Sequence[Obstacle]]) -> ObstacleParts:
    """The parts of all maps' obstacles, for the compiled loops."""
    rows = [list(_parts_of(obstacles)) for obstacles in maps]
    parts = [part for row in rows for part in row]
    corners = [corner for _, part in parts if isinstance(part.shape, Polygon) for corner in part.shape.points]
    counts = [len(part.shape.points) if isinstance(part.shape, Polygon) else 0 for _, part in parts]
    circles = [
        (*part.shape.center, part.shape.radius) if isinstance(part.shape, Circle) else (0.0, 0.0, 0.0)
        for _, part in parts
    ]
    return ObstacleParts(
        map_parts=np.cumsum([0, *map(len, rows)], dtype=np.int64),
        body=np.array([body for body, _ in parts], dtype=np.int64),
        circles=np.array(circles, dtype=np.float64).reshape(-1, 3),
        corners=np.array(corners, dtype=np.float64).reshape(-1, 2),
        starts=np.cumsum([0, *counts], dtype=np.int64),
        bits=np.array([part.bits for _, part in parts], dtype=np.int64),
        reach=np.array([_outer_radius(part.shape) for _, part in parts], dtype=np.float64),
    )


def _parts_of(obstacles: Sequence[Obstacle]) -> Iterator[tuple[int, ObstaclePart]]:
    for body, obstacle in enumerate(obstacles):
        for part in obstacle.parts:
            yield body, part


def _outer_radius(shape: Circle | Polygon) -> float:
    if isinstance(shape, Circle):
        return math.hypot(*shape.center) + shape.radius
    return max(math.hypot(x, y) for x, y in shape.points)
