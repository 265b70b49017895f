"""The goal to keep away from what moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from kit.arrays import FloatArray
from kit.learning.tasks.goals.goal import Goal, GoalCase, GoalCount
from kit.learning.tasks.transition import Transition
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class AvoidGoal(Goal):
    """No robot comes near a moving model."""

    distance: float = 0.4
    """Seconds count in which every moving model is farther than this from every robot's origin [m]."""
    time: float = 20.0
    """Total time [s]."""

    kind: ClassVar[str] = "avoid"
    needs_obstacles: ClassVar[bool] = True

    @classmethod
    def read(cls, section: Section) -> Self:
        usual = cls()
        return cls(
            section.number("distance", usual.distance, minimum=0), section.number("time", usual.time, above=0)
        )

    @property
    def description(self) -> str:
        return f"be more than {self.distance:g} m from everything that moves, for {self.time:g} s in total"

    def least_time(self, way: float, speed: float) -> float:
        return self.time

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _AvoidCount(self, cases, step_time)

    def progress(self, count: float, needed: float) -> str:
        return f"{count:.1f} of {needed:g} s away from everything"


class _AvoidCount(GoalCount):
    """Seconds in which every robot was far enough from everything that is neither wall nor robot."""

    def __init__(self, goal: AvoidGoal, cases: Sequence[GoalCase], step_time: float) -> None:
        self._goal, self._step_time = goal, step_time
        self.needed = np.full(len(cases), goal.time)

    def count(self, transition: Transition) -> FloatArray:
        away = (transition.obstacle_distance > self._goal.distance).all(axis=1)
        counts: FloatArray = transition.before.count + np.where(
            away & ~transition.collided, self._step_time, 0.0
        )
        return counts
