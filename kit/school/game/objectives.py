"""What a level asks for, measured on the exact simulation: targets, a floor to cover, a leader to follow, a battery."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Final

import numpy as np

from kit.learning.environment.batch_map import FLOOR_CELL, measure_floor
from kit.learning.tasks.goals import CoverGoal, FollowGoal, PatrolGoal
from kit.render.scene import Disc
from kit.run.metrics import MetricsRecorder
from kit.world.catalogue import find_map

if TYPE_CHECKING:
    from kit.run.scenario import Scenario
    from kit.school.game.levels import GameLevel, LevelConditions
    from kit.sim.simulation import Simulation

DOCK_RADIUS: Final = 0.25
"""A robot stands at a dock within this distance of it [m]."""
DOCK_TIME: Final = 1.0
"""Standing still for this time charges the battery [s]."""
STILL: Final = 1e-4
"""A robot that moves less than this in a tick stands still [m]."""


class Objective(ABC):
    """What is to be achieved. ``on_step`` is called after every tick until it is."""

    reached_s: float | None = None
    """When it was achieved [simulated s]."""
    splits: tuple[float, ...] = ()
    """When each part of it was achieved [simulated s]."""

    @abstractmethod
    def on_step(self, simulation: Simulation) -> None: ...

    def put_back(self) -> None:  # noqa: B027 - only where what was achieved lies along a way
        """A robot has bumped and was put back to its start."""

    @property
    @abstractmethod
    def progress(self) -> str:
        """How much of it is achieved, in a few words; empty where there is nothing to count."""

    @property
    def discs(self) -> tuple[Disc, ...]:
        """The targets that are still to be reached."""
        return ()


class TargetObjective(Objective):
    """All robots are in the case's target at the same time."""

    progress = ""

    def __init__(self, metrics: MetricsRecorder, scenario: Scenario) -> None:
        self._metrics = metrics
        case = scenario.case
        self._discs = () if case is None else (Disc(*case.target, case.target_radius),)

    def on_step(self, simulation: Simulation) -> None:
        self.reached_s = self._metrics.all_reached_s

    @property
    def discs(self) -> tuple[Disc, ...]:
        return self._discs


class PatrolObjective(Objective):
    """All robots are in each target at the same time, one target after the other or in any order."""

    def __init__(self, level: GameLevel, scenario: Scenario) -> None:
        assert isinstance(level.goal, PatrolGoal)
        radius = 0.25 if scenario.case is None else scenario.case.target_radius
        self._all = [Disc(x, y, radius) for x, y in level.goal.route(level.targets)]
        self._left = list(self._all)
        self._any_order = level.any_order
        self._count = len(self._all)
        self._partners = scenario.partners

    def on_step(self, simulation: Simulation) -> None:
        for disc in self._left if self._any_order else self._left[:1]:
            if all(
                simulation.hull_distance(name, (disc.x, disc.y)) <= disc.radius for name in self._partners
            ):
                self._left.remove(disc)
                now = simulation.time_ns / 1e9
                self.splits = (*self.splits, now)
                if not self._left:
                    self.reached_s = now
                return

    def put_back(self) -> None:
        """All targets are to be reached again: else a bump would be the shortest way home."""
        self._left, self.splits = list(self._all), ()

    @property
    def progress(self) -> str:
        return f"{self._count - len(self._left)} of {self._count} targets"

    @property
    def discs(self) -> tuple[Disc, ...]:
        return tuple(self._left) if self._any_order else tuple(self._left[:1])


class CoverObjective(Objective):
    """A share of the floor is driven over."""

    def __init__(self, goal: CoverGoal, map_name: str, scenario: Scenario) -> None:
        from kit.learning.environment.batch_map import hull_radius, hull_width, load_batch_map

        assert scenario.robot is not None  # a level has one
        batch_map = load_batch_map(find_map(map_name))
        floor, start = measure_floor(batch_map), scenario.starts[0]
        self._floor = floor.reached_from(start.x, start.y, hull_width(batch_map)) & (
            floor.clearance > max(hull_radius(batch_map) - goal.radius, 0.0)
        )
        self._x, self._y = np.meshgrid(floor.x, floor.y)
        self._covered = np.zeros_like(self._floor)
        self._robot = scenario.robot
        self._goal = goal

    @property
    def share(self) -> float:
        """The share of the floor that is covered."""
        return float((self._covered & self._floor).sum() / self._floor.sum())

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick % 5:  # 25 mm at full speed, half a cell
            return
        pose, radius = simulation.pose(self._robot), self._goal.radius
        column = round((pose.x - self._x[0, 0]) / FLOOR_CELL)
        row = round((pose.y - self._y[0, 0]) / FLOOR_CELL)
        reach = math.ceil(radius / FLOOR_CELL)
        window = (
            slice(max(row - reach, 0), max(row + reach + 1, 0)),
            slice(max(column - reach, 0), max(column + reach + 1, 0)),
        )
        self._covered[window] |= np.hypot(self._x[window] - pose.x, self._y[window] - pose.y) <= radius
        if self.share >= self._goal.share:
            self.reached_s = simulation.time_ns / 1e9

    @property
    def uncovered(self) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        """(k, 2) the middles of the floor's cells that are still to be covered [m]."""
        left = self._floor & ~self._covered
        return np.stack([self._x[left], self._y[left]], axis=1)

    @property
    def progress(self) -> str:
        return f"{self.share:.0%} of {self._goal.share:.0%} covered"


class FollowObjective(Objective):
    """The robot stays near a leader for a time."""

    def __init__(self, goal: FollowGoal, leader: str, scenario: Scenario) -> None:
        self._goal, self._leader, self._partners = goal, leader, scenario.partners
        self._seconds = 0.0

    def on_step(self, simulation: Simulation) -> None:
        leader = simulation.pose(self._leader)
        distances = [math.dist(simulation.pose(name)[:2], leader[:2]) for name in self._partners]
        if all(self._goal.nearest <= each <= self._goal.farthest for each in distances):
            self._seconds += simulation.step_size
        if self._seconds >= self._goal.time:
            self.reached_s = simulation.time_ns / 1e9

    @property
    def progress(self) -> str:
        return f"{self._seconds:.1f} of {self._goal.time:g} s near the leader"


class Battery:
    """The charge of a robot's battery: used by driving, refilled by standing still at a dock."""

    def __init__(self, conditions: LevelConditions, robot: str) -> None:
        self._conditions, self._robot = conditions, robot
        self.charge = conditions.charge
        """Distance that is left [m]."""
        self._still_s = 0.0
        self._last: tuple[float, float] | None = None

    @property
    def is_empty(self) -> bool:
        return self._conditions.charge > 0.0 and self.charge <= 0.0

    def on_step(self, simulation: Simulation) -> None:
        x, y, _ = simulation.pose(self._robot)
        stride = 0.0 if self._last is None else math.dist((x, y), self._last)
        self._last = x, y
        self.charge -= stride
        self._still_s = self._still_s + simulation.step_size if stride < STILL else 0.0
        is_docked = any(math.dist((x, y), dock) <= DOCK_RADIUS for dock in self._conditions.docks)
        if is_docked and self._still_s >= DOCK_TIME:
            self.charge = self._conditions.charge


def objective_of(level: GameLevel, scenario: Scenario, metrics: MetricsRecorder) -> Objective:
    """The objective of a level's drive."""
    match level.goal:
        case PatrolGoal():
            return PatrolObjective(level, scenario)
        case CoverGoal():
            return CoverObjective(level.goal, level.map_name, scenario)
        case FollowGoal():
            return FollowObjective(level.goal, level.leader, scenario)
        case _:
            return TargetObjective(metrics, scenario)
