"""Keeping score of one drive: how far, how long, how often bumped, and whether the target was reached."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kit.geometry import Pose
from kit.world.catalogue import Case

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


LONGEST_STRIDE = 0.1
"""A robot that is farther [m] from where it was one tick ago was moved by hand."""

LARGEST_ROBOT = 1.0
"""No part of a robot is farther [m] from its origin."""


class Trip:
    """Watches the runner's ticks for one robot and one case."""

    def __init__(self, robot: str | None, case: Case | None) -> None:
        self._robot = robot
        self._case = case
        self._last_tick = -1
        self._simulation: Simulation | None = None
        self._at: tuple[float, float] | None = None
        self._reached: float | None = None
        self._touching = False
        self._distance = self._time_s = 0.0
        self._bumps = 0
        self._start()

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

    def accepted(self, topic: str, message: Any) -> None:
        """Commands do not count; only what comes of them."""

    def called(self, service: str, *arguments: Any) -> None:
        """Nor do services."""

    def ticked(self, simulation: Simulation) -> None:
        if simulation.tick <= self._last_tick:  # it was reset
            self._start()
        self._last_tick = simulation.tick
        self._simulation = simulation
        self._time_s = simulation.time_ns / 1e9
        if self._robot is None or self._robot not in simulation.model_names:
            return
        pose = simulation.pose(self._robot)
        if self._at is not None:
            stride = math.hypot(pose.x - self._at[0], pose.y - self._at[1])
            if stride <= LONGEST_STRIDE:
                self._distance += stride
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
        if away > case.target_radius + LARGEST_ROBOT:  # most ticks: spare the hull
            return False
        assert self._robot is not None
        return simulation.hull_distance(self._robot, case.target) < case.target_radius

    def _start(self) -> None:
        self._at = None
        self._touching = False
        self._distance = 0.0
        self._bumps = 0
        self._reached = None
        self._time_s = 0.0
