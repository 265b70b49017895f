"""The state of a simulation at one instant: plain frozen records, safe to hand to another thread."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kit.arrays import Float32Array, FloatArray
from kit.geometry import Pose
from kit.kernels.arrays import Beams
from kit.world.records import Color


@dataclass(frozen=True, slots=True)
class BodyState:
    """One body: its pose in the world, and the velocity of its origin [m/s, m/s, rad/s], world frame."""

    model: str
    body: str
    pose: Pose
    velocity: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Contact:
    """Two footprints that touch. A wall is named by its layer's first name, as entity and as body."""

    entity_a: str
    body_a: str
    entity_b: str
    body_b: str
    points: tuple[tuple[float, float], ...]
    """World coordinates [m]; empty for a sensor footprint."""
    normal: tuple[float, float]
    """Unit vector from a to b."""
    force: float
    """Mean impulse over the step divided by its length [N]; a rough figure."""

    @property
    def reversed(self) -> Contact:
        """The contact with a and b exchanged."""
        x, y = self.normal
        return Contact(
            self.entity_b, self.body_b, self.entity_a, self.body_a, self.points, (-x, -y), self.force
        )


@dataclass(frozen=True, slots=True)
class SimulationState:
    time_ns: int
    tick: int
    bodies: tuple[BodyState, ...]
    """Bodies in load order: model by model, body by body."""
    contacts: tuple[Contact, ...]

    def pose(self, model: str, body: str | None = None) -> Pose:
        """The pose of a model's body, by default its first. KeyError if there is none."""
        for state in self.bodies:
            if state.model == model and body in (None, state.body):
                return state.pose
        raise KeyError(model if body is None else f"{model}/{body}")


@dataclass(frozen=True, slots=True)
class FootprintOutline:
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
class LatestScan:
    """The latest scan of a laser."""

    model: str
    plugin: str
    pose: Pose
    """The sensor's, in the world."""
    beams: Beams
    """The directions of its rays, in its own frame."""
    ranges: Float32Array
    """(rays,) [m], noise included, NaN where nothing is in range."""
    max_range: float
    """How far the laser sees [m]."""

    @property
    def hits(self) -> FloatArray:
        """(hits, 2) ``x y`` in the world [m]."""
        seen = ~np.isnan(self.ranges)
        ranges, cos, sin = self.ranges[seen], self.beams.cos[seen], self.beams.sin[seen]
        turn = np.exp(1j * self.pose.theta)
        ends = ranges * (cos + 1j * sin) * turn + complex(self.pose.x, self.pose.y)
        return np.column_stack([ends.real, ends.imag])
