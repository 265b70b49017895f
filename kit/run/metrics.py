"""Metrics of a drive, per robot: time, distance, bumps, and when the target was reached."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

from kit.run.lockstep import Observer
from kit.world.records import Circle, Model, Polygon

if TYPE_CHECKING:
    from kit.run.scenario import Scenario
    from kit.sim.simulation import Simulation


@dataclass(frozen=True, slots=True)
class DriveMetrics:
    """One robot's drive so far, since the last reset."""

    time_s: float = 0.0
    """Simulated."""
    distance_m: float = 0.0
    """Length of the path; jumps (a robot sent home) do not count."""
    bumps: int = 0
    """Number of times that the robot began to touch something."""
    target_m: float | None = None
    """From the robot's hull to the target's middle now; None without a target."""
    reached_s: float | None = None
    """When the hull was first at most the target's radius away from the target's middle; None if it never was."""


class _RobotMetrics:
    """The state of one robot's measurement."""

    __slots__ = (
        "at",
        "bump_steps",
        "bumps",
        "contact_steps",
        "distance",
        "is_touching",
        "name",
        "reach",
        "reached",
    )

    def __init__(self, model: Model) -> None:
        self.name = model.name
        self.reach = _outer_radius(model)
        self.bump_steps: list[int] = []
        self.contact_steps = 0
        self.restart()

    def restart(self) -> None:
        self.at: tuple[float, float] | None = None
        self.reached: float | None = None
        self.is_touching = False
        self.distance = 0.0
        self.bumps = 0


class MetricsRecorder(Observer):
    """Measures the drives of ``robots`` as one of a runner's observers; a reset of the world begins again.

    A robot has arrived when the distance from its hull to the middle of ``target`` [m, m] is at most ``radius`` [m]. A bump
    begins when a touch begins.
    """

    def __init__(
        self, robots: Iterable[Model], target: tuple[float, float] | None = None, radius: float = 0.0
    ) -> None:
        self._robots = tuple(_RobotMetrics(model) for model in robots)
        self._by_name = {robot.name: robot for robot in self._robots}
        self._target = target
        self._radius = radius
        self._last_tick = -1
        self._steps = 0
        self._simulation: Simulation | None = None
        self._time_s = 0.0
        self.all_reached_s: float | None = None
        """When all robots were in the target together for the first time [simulated s]; None if they never were."""

    @classmethod
    def for_scenario(cls, scenario: Scenario) -> Self:
        """Measures all robots that drive from start to target."""
        models = {model.name: model for model in scenario.world.models}
        robots = [models[name] for name in scenario.partners]
        case = scenario.case
        return cls(robots) if case is None else cls(robots, case.target, case.target_radius)

    @property
    def metrics(self) -> DriveMetrics:
        """The first robot's, as of the last step."""
        return self.metrics_of(self._robots[0].name) if self._robots else DriveMetrics(self._time_s)

    @property
    def total_bumps(self) -> int:
        """Bumps of all robots together."""
        return sum(robot.bumps for robot in self._robots)

    def metrics_of(self, name: str) -> DriveMetrics:
        """Returns a robot's metrics after the last step. Raises KeyError for a robot that is not measured."""
        robot, target = self._by_name[name], None
        if self._target is not None and self._simulation is not None and name in self._simulation.model_names:
            target = self._simulation.hull_distance(name, self._target)
        return DriveMetrics(self._time_s, robot.distance, robot.bumps, target, robot.reached)

    def bump_steps(self, name: str) -> tuple[int, ...]:
        """Returns the steps in which bumps began, counted from the first observed step; resets do not restart it."""
        return tuple(self._by_name[name].bump_steps)

    def contact_steps(self, name: str) -> int:
        """Returns the number of steps in which the robot touched something; resets do not restart the count."""
        return self._by_name[name].contact_steps

    def on_service(self, service: str, *arguments: Any) -> None:
        """A robot that is put somewhere has not driven there."""
        for robot in self._robots:
            robot.at = None

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick <= self._last_tick:  # it was reset
            self._restart()
        self._last_tick = simulation.tick
        self._simulation = simulation
        self._time_s = simulation.time_ns / 1e9
        are_inside = bool(self._robots)
        for robot in self._robots:
            are_inside = self._measure_robot(robot, simulation) and are_inside
        if are_inside and self.all_reached_s is None:
            self.all_reached_s = self._time_s
        self._steps += 1

    def _measure_robot(self, robot: _RobotMetrics, simulation: Simulation) -> bool:
        """Adds a step of one robot's. Returns whether it is in the target."""
        if robot.name not in simulation.model_names:
            robot.is_touching = False
            return False
        x, y, _ = simulation.pose(robot.name)
        if robot.at is not None:
            robot.distance += math.hypot(x - robot.at[0], y - robot.at[1])
        robot.at = x, y
        is_touching = simulation.is_touching(robot.name)
        if is_touching:
            robot.contact_steps += 1
            if not robot.is_touching:
                robot.bumps += 1
                robot.bump_steps.append(self._steps)
        robot.is_touching = is_touching
        if self.all_reached_s is not None or not self._is_in_target(robot, simulation, x, y):
            return False
        if robot.reached is None:
            robot.reached = self._time_s
        return True

    def _is_in_target(self, robot: _RobotMetrics, simulation: Simulation, x: float, y: float) -> bool:
        if self._target is None:
            return False
        if math.hypot(x - self._target[0], y - self._target[1]) > self._radius + robot.reach:
            return False  # most steps: spare the hull
        return is_in_target(simulation, robot.name, self._target, self._radius)

    def _restart(self) -> None:
        self.all_reached_s = None
        for robot in self._robots:
            robot.restart()


def is_in_target(simulation: Simulation, robot: str, target: tuple[float, float], radius: float) -> bool:
    """Whether a robot has arrived: some part of it is within ``radius`` [m] of the target. The rule of every episode."""
    return simulation.hull_distance(robot, target) <= radius


def _outer_radius(model: Model) -> float:
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
