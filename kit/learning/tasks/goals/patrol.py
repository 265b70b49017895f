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

STILL = 1e-4
"""A robot that moves less than this in a step stands still [m]."""
ROUNDING = 1e-6
"""By so much of its time robots may have stood too little."""


@dataclass(frozen=True, slots=True)
class PatrolGoal(Goal):
    """The case's targets are reached one after the other."""

    rounds: int = 1
    """Number of rounds through all targets."""
    stay: float = 0.0
    """For so long all robots stand still in a target before it counts [s]."""

    kind: ClassVar[str] = "patrol"
    case_targets: ClassVar[CaseTargets] = CaseTargets.ROUTE
    is_lost_at_start: ClassVar[bool] = True

    @classmethod
    def read(cls, section: Section) -> Self:
        return cls(
            section.integer("rounds", 1, minimum=1, maximum=100),
            section.number("stay", 0.0, minimum=0, maximum=60),
        )

    @property
    def description(self) -> str:
        stay = f", and stand still for {self.stay:g} s in each" if self.stay else ""
        return f"reach all targets in their order, {counted(self.rounds, 'time')}{stay}"

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _PatrolCount(self, cases, step_time)

    @property
    def needs_count(self) -> bool:
        return self.stay > 0.0

    def progress(self, count: float, needed: float) -> str:
        return f"{int(count)} of {needed:.0f} targets"

    def route(self, targets: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        return targets * self.rounds


class _PatrolCount(GoalCount):
    """The number of targets that have been reached, and the share of the time that robots have stood in the next one."""

    def __init__(self, goal: PatrolGoal, cases: Sequence[GoalCase], step_time: float) -> None:
        self._share = step_time / goal.stay if goal.stay else 1.0
        self.needed = np.array([float(goal.rounds * case.target_count) for case in cases])

    def count(self, transition: Transition) -> FloatArray:
        arrived = transition.in_target.all(axis=1) & ~transition.collided
        before = transition.before.count
        counts: FloatArray
        if self._share >= 1.0:
            counts = before + arrived
            return counts
        ways = np.hypot(*np.moveaxis(transition.pose - transition.previous_pose, -1, 0)[:2])
        stood = before % 1.0 + self._share
        stood = np.where(stood > 1.0 - ROUNDING, 1.0, stood)
        counts = np.floor(before) + np.where(arrived & (ways < STILL).all(axis=1), stood, 0.0)
        return counts
