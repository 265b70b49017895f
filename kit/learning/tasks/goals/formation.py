"""The goal of several robots to drive while they keep a distance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from kit.arrays import FloatArray
from kit.learning.tasks.goals.goal import Goal, GoalCase, GoalCount, read_distances
from kit.learning.tasks.transition import Transition, average_speeds
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class FormationGoal(Goal):
    """Robots drive while each keeps a distance from the next one."""

    nearest: float = 0.3
    farthest: float = 0.7
    """Between these distances [m] of the robots' origins metres count."""
    length: float = 4.0
    """Total length, the mean of all robots [m]."""

    kind: ClassVar[str] = "formation"
    least_robots: ClassVar[int] = 2

    @classmethod
    def read(cls, section: Section) -> Self:
        usual = cls()
        distances = read_distances(section, usual.nearest, usual.farthest)
        return cls(*distances, section.number("length", usual.length, above=0))

    @property
    def description(self) -> str:
        return (
            f"drive {self.length:g} m, each robot {self.nearest:g} to {self.farthest:g} m from the next one"
        )

    def least_time(self, way: float, speed: float) -> float:
        return self.length / speed

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _FormationCount(self, cases, step_time)

    def progress(self, count: float, needed: float) -> str:
        return f"{count:.1f} of {needed:g} m in formation"


class _FormationCount(GoalCount):
    """Metres driven forward in formation, the mean of all robots."""

    def __init__(self, goal: FormationGoal, cases: Sequence[GoalCase], step_time: float) -> None:
        self._goal, self._step_time = goal, step_time
        self.needed = np.full(len(cases), goal.length)

    def count(self, transition: Transition) -> FloatArray:
        apart = np.diff(transition.pose[:, :, :2], axis=1)
        distance = np.hypot(apart[:, :, 0], apart[:, :, 1])
        is_kept = ((distance >= self._goal.nearest) & (distance <= self._goal.farthest)).all(axis=1)
        speeds = average_speeds(transition.previous_pose, transition.pose, self._step_time)
        metres = np.maximum(speeds[:, :, 0], 0.0).mean(axis=1) * self._step_time
        counts: FloatArray = transition.before.count + np.where(is_kept & ~transition.collided, metres, 0.0)
        return counts
