"""The goal to drive along a wall."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, Self

import numpy as np

from kit.arrays import FloatArray
from kit.learning.tasks.goals.goal import Goal, GoalCase, GoalCount
from kit.learning.tasks.transition import Transition, average_speeds
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class WallGoal(Goal):
    """Every robot drives along a wall on one side of it."""

    side: Literal["left", "right"] = "right"
    distance: float = 0.25
    """From the lidar to the wall [m]."""
    tolerance: float = 0.1
    """Metres driven count where the distance is off by at most this [m]."""
    length: float = 5.0
    """Total length [m]."""

    kind: ClassVar[str] = "wall"
    is_observation_delayed: ClassVar[bool] = True
    reads_lidar: ClassVar[bool] = True

    @classmethod
    def read(cls, section: Section) -> Self:
        usual = cls()
        sides: Mapping[str, Literal["left", "right"]] = {"left": "left", "right": "right"}
        return cls(
            section.choice("side", sides, usual.side),
            section.number("distance", usual.distance, above=0),
            section.number("tolerance", usual.tolerance, above=0),
            section.number("length", usual.length, above=0),
        )

    @property
    def description(self) -> str:
        return (
            f"drive {self.length:g} m with a wall on the {self.side}, "
            f"{self.distance - self.tolerance:g} to {self.distance + self.tolerance:g} m away"
        )

    @property
    def farthest_measured(self) -> float:
        return self.distance + self.tolerance

    def least_time(self, way: float, speed: float) -> float:
        return self.length / speed

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _WallCount(self, cases, step_time)

    def progress(self, count: float, needed: float) -> str:
        return f"{count:.1f} of {needed:g} m along the wall"


class _WallCount(GoalCount):
    """Metres driven beside a wall, the mean of all robots."""

    def __init__(self, goal: WallGoal, cases: Sequence[GoalCase], step_time: float) -> None:
        self._goal, self._step_time = goal, step_time
        self.needed = np.full(len(cases), goal.length)

    def count(self, transition: Transition) -> FloatArray:
        goal, time = self._goal, self._step_time
        beside = transition.beside_left if goal.side == "left" else transition.beside_right
        forward = average_speeds(transition.previous_pose, transition.pose, time)[:, :, 0] * time
        metres = (np.abs(beside - goal.distance) <= goal.tolerance) * np.maximum(forward, 0.0)
        counts: FloatArray = transition.before.count + np.where(transition.collided, 0.0, metres.mean(axis=1))
        return counts
