"""Keeping score of one drive: how far, how long, how often bumped, and whether the target was reached."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kit.geometry import Pose
from kit.run.lockstep import Observer
from kit.world.catalogue import Case
from kit.world.records import Circle, Model, Polygon

if TYPE_CHECKING:
    from kit.sim.simulation import Simulation


@dataclass(frozen=True, slots=True)
class Score:
    """A drive so far, since the last reset."""

    time_s: float = 0.0
    """Simulated."""
    distance_m: float = 0.0
    """Along the way; jumps (a robot sent home) do not count."""
    bumps: int = 0
    """How often the robot began to touch something."""
    target_m: float | None = None
    """From the robot's hull to the target's middle now; None without a target."""
    reached_s: float | None = None
    """When the hull first came within the target's radius."""


class Trip(Observer):
    """Watches the runner's ticks for one robot and one case."""

    def __init__(self, robot: Model | None, case: Case | None) -> None:
        self._robot = None if robot is None else robot.name
        self._reach = 0.0 if robot is None else _reach(robot)
        self._case = case
        self._last_tick = -1
        self._simulation: Simulation | None = None
        self._at: tuple[float, float] | None = None
        self._reached: float | None = None
        self._touching = False
        self._distance = self._time_s = 0.0
        self._bumps = 0

    @property
    def score(self) -> Score:
        """As of the last tick."""
        target = None
        if (
            self._case is not None
            and self._simulation is not None
            and self._robot in self._simulation.model_names
        ):
            target = self._simulation.hull_distance(self._robot, self._case.target)
        return Score(self._time_s, self._distance, self._bumps, target, self._reached)

    def on_service(self, service: str, *arguments: Any) -> None:
        """A robot that is put somewhere has not driven there."""
        self._at = None

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick <= self._last_tick:  # it was reset
            self._start()
        self._last_tick = simulation.tick
        self._simulation = simulation
        self._time_s = simulation.time_ns / 1e9
        if self._robot is None or self._robot not in simulation.model_names:
            return
        pose = simulation.pose(self._robot)
        if self._at is not None:
            self._distance += math.hypot(pose.x - self._at[0], pose.y - self._at[1])
        self._at = pose.x, pose.y
        touching = simulation.touches(self._robot)
        self._bumps += touching and not self._touching
        self._touching = touching
        if (
            self._case is not None
            and self._reached is None
            and self._is_in_target(simulation, self._case, pose)
        ):
            self._reached = self._time_s

    def _is_in_target(self, simulation: Simulation, case: Case, pose: Pose) -> bool:
        away = math.hypot(pose.x - case.target[0], pose.y - case.target[1])
        if away > case.target_radius + self._reach:  # most ticks: spare the hull
            return False
        assert self._robot is not None
        return simulation.hull_distance(self._robot, case.target) < case.target_radius

    def _start(self) -> None:
        self._at = self._reached = None
        self._touching = False
        self._distance = self._time_s = 0.0
        self._bumps = 0


def _reach(model: Model) -> float:
    """No part of the model gets farther [m] from its first body's origin, however its joints turn."""
    reach = 0.0
    for body in model.bodies:
        shapes = [footprint.shape for footprint in body.footprints]
        corners = [
            math.hypot(*point) for shape in shapes if isinstance(shape, Polygon) for point in shape.points
        ]
        rims = [math.hypot(*shape.center) + shape.radius for shape in shapes if isinstance(shape, Circle)]
        reach += math.hypot(body.pose.x, body.pose.y) + max((*corners, *rims), default=0.0)
    return reach
