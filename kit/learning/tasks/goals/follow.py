"""The goal to stay near a target that moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from kit.arrays import FloatArray
from kit.learning.tasks.goals.goal import CaseTargets, Goal, GoalCase, GoalCount, read_distances
from kit.learning.tasks.transition import Transition
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class FollowGoal(Goal):
    """Every robot stays near a target that moves."""

    nearest: float = 0.3
    farthest: float = 0.8
    """Between these distances [m] from the target's middle time counts."""
    time: float = 20.0
    """Total time [s]."""

    kind: ClassVar[str] = "follow"
    case_targets: ClassVar[CaseTargets] = CaseTargets.LEADER

    @classmethod
    def read(cls, section: Section) -> Self:
        usual = cls()
        distances = read_distances(section, usual.nearest, usual.farthest)
        return cls(*distances, section.number("time", usual.time, above=0))

    @property
    def description(self) -> str:
        return f"be {self.nearest:g} to {self.farthest:g} m from the leader for {self.time:g} s in total"

    def least_time(self, way: float, speed: float) -> float:
        return self.time

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _FollowCount(self, cases, step_time)

    def progress(self, count: float, needed: float) -> str:
        return f"{count:.1f} of {needed:g} s near the leader"


class _FollowCount(GoalCount):
    """Seconds in which every robot was near its leader."""

    def __init__(self, goal: FollowGoal, cases: Sequence[GoalCase], step_time: float) -> None:
        self._goal, self._step_time = goal, step_time
        self.needed = np.full(len(cases), goal.time)

    def count(self, transition: Transition) -> FloatArray:
        distance = transition.distance
        near = ((distance >= self._goal.nearest) & (distance <= self._goal.farthest)).all(axis=1)
        counts: FloatArray = transition.before.count + np.where(
            near & ~transition.collided, self._step_time, 0.0
        )
        return counts
