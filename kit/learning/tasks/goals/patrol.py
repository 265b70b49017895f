"""The goal to reach the targets of a case one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from kit.arrays import FloatArray
from kit.learning.tasks.goals.goal import CaseTargets, Goal, GoalCase, GoalCount
from kit.learning.tasks.transition import Transition
from kit.plain_text import counted
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class PatrolGoal(Goal):
    """The case's targets are reached one after the other."""

    rounds: int = 1
    """Number of rounds through all targets."""

    kind: ClassVar[str] = "patrol"
    case_targets: ClassVar[CaseTargets] = CaseTargets.ROUTE
    is_lost_at_start: ClassVar[bool] = True

    @classmethod
    def read(cls, section: Section) -> Self:
        return cls(section.integer("rounds", 1, minimum=1, maximum=100))

    @property
    def description(self) -> str:
        return f"reach all targets in their order, {counted(self.rounds, 'time')}"

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _PatrolCount(self, cases)

    def progress(self, count: float, needed: float) -> str:
        return f"{count:.0f} of {needed:.0f} targets"

    def route(self, targets: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        return targets * self.rounds


class _PatrolCount(GoalCount):
    """The number of targets that have been reached."""

    def __init__(self, goal: PatrolGoal, cases: Sequence[GoalCase]) -> None:
        self.needed = np.array([float(goal.rounds * case.target_count) for case in cases])

    def count(self, transition: Transition) -> FloatArray:
        arrived = transition.in_target.all(axis=1) & ~transition.collided
        counts: FloatArray = transition.before.count + arrived
        return counts
