"""What is the same for every goal that a node counts. Written into the program of each exported policy; needs numpy alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np


class GoalStep(NamedTuple):
    """A step of the robots, as their program knows it."""

    poses: np.ndarray
    """(robots, 3): after the step."""
    before: np.ndarray
    """(robots, 3): before it."""
    arrived: bool
    """Whether all robots are in the target."""
    place: Any
    """(2,): where the target is [m]."""
    beside: np.ndarray
    """(robots, 2): the nearest things to the left and to the right of each robot's lidar [m]."""

    @property
    def forward(self) -> np.ndarray:
        """(robots,): metres that each drove forward, none for those that drove backward."""
        dx, dy, turn = (self.poses - self.before).T
        middle = self.before[:, 2] + 0.5 * ((turn + np.pi) % (2 * np.pi) - np.pi)
        metres: np.ndarray = np.maximum(dx * np.cos(middle) + dy * np.sin(middle), 0.0)
        return metres


class NodeCount:
    """How much of the goal is achieved: nothing, where the policy is not told."""

    def __init__(self, facts: dict[str, Any]) -> None:
        self.facts = facts
        self.needed: float = facts.get("needed", 1.0)
        self.is_observation_delayed: bool = facts.get("is_observation_delayed", False)

    def begin(self, poses: np.ndarray) -> float:
        """The count at the start of an episode, with robots at ``poses`` (robots, 3)."""
        return 0.0

    def count(self, count: float, step: GoalStep) -> float:
        """The count after a step."""
        return count

    def is_done(self, before: float, count: float, step: GoalStep) -> bool:
        """Whether the robots are done with the target of a route, where the count was ``before``."""
        return step.arrived

    def is_within(self, distance: np.ndarray) -> bool:
        """Whether all distances [m] lie between the goal's nearest and farthest."""
        return bool(((distance >= self.facts["nearest"]) & (distance <= self.facts["farthest"])).all())


class GoalProgress:
    """How far the robots have come with their goal: where they are to go next, who is there, what share is achieved."""

    def __init__(
        self,
        goal_count: NodeCount,
        is_inside: Callable[[int, np.ndarray, Sequence[float]], bool],
        route: Sequence[Sequence[float]],
        robots: int,
    ) -> None:
        """``is_inside``: whether the robot of this number has arrived, at a pose (3,), at a place (2,). ``route``: the places
        to go to, one after the other."""
        self.goal_count = goal_count
        self.is_inside = is_inside
        self.robots = robots
        self.begin_route(route)
        self.forget()

    def begin_route(self, route: Sequence[Sequence[float]]) -> None:
        """Goes to these places, one after the other; to none before one is told."""
        self.route = self.left = route
        self.target: Sequence[float] = route[0] if route else (math.nan, math.nan)

    def forget(self) -> None:
        """Begins to count again, as at the start of an episode."""
        self.before: np.ndarray | None = None
        self.achieved = self.share = self.told_share = 0.0
        self.inside = [False] * self.robots

    @property
    def needed(self) -> float:
        """The count at which the goal is reached."""
        return float(len(self.route)) if len(self.route) > 1 else self.goal_count.needed

    def step(self, poses: np.ndarray, beside: np.ndarray) -> None:
        """Counts how much of the goal is achieved with robots at ``poses`` (robots, 3), and goes on to the next target of a
        route that is reached. ``beside`` (robots, 2): the nearest things to the left and to the right of each lidar [m]."""
        self.find_arrivals(poses)
        if self.before is None:
            self.achieved = self.goal_count.begin(poses)
            self.share = self.told_share = self.achieved / self.needed
        else:
            arrived = all(self.inside)
            step = GoalStep(poses, self.before, arrived, np.array(self.target), beside)
            before, self.achieved = self.achieved, self.goal_count.count(self.achieved, step)
            earlier, self.share = self.share, self.achieved / self.needed
            self.told_share = earlier if self.goal_count.is_observation_delayed else self.share
            if len(self.left) > 1 and self.goal_count.is_done(before, self.achieved, step):
                self.left = self.left[1:]
                self.target = self.left[0]
                self.find_arrivals(poses)
        self.before = poses

    def find_arrivals(self, poses: np.ndarray) -> None:
        """Notes which robots are in the target."""
        self.inside = [self.is_inside(robot, pose, self.target) for robot, pose in enumerate(poses)]

    def part_numbers(self, part: str, robot: int) -> list[float]:
        """The numbers of a part of what agents are told: the share that is ``achieved``, or whether a robot has ``arrived``."""
        return [min(self.told_share, 1.0) if part == "achieved" else float(self.inside[robot])]
