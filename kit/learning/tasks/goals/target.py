"""The goal to be in a target: that of most tasks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Final, Self

import numpy as np

from kit.arrays import FloatArray
from kit.geometry import wrap_angle
from kit.learning.tasks.goals.goal import CaseTargets, Goal, GoalCase, GoalCount
from kit.learning.tasks.transition import Array, Transition
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class TargetGoal(Goal):
    """Every robot is in the target at the same time."""

    heading_tolerance: float | None = None
    """The target's heading must be kept within this [rad]; None: any heading will do."""

    kind: ClassVar[str] = "target"
    case_targets: ClassVar[CaseTargets] = CaseTargets.PLACE

    @classmethod
    def read(cls, section: Section) -> Self:
        if not section.has("heading_tolerance"):
            return cls()
        return cls(section.number("heading_tolerance", above=0, maximum=math.pi))

    @property
    def description(self) -> str:
        if self.heading_tolerance is None:
            return "be in the target"
        return f"be in the target, within {self.heading_tolerance:g} rad of its heading"

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _TargetCount(cases)

    def progress(self, count: float, needed: float) -> str:
        return ""

    def is_arrived(self, inside: Array, poses: Array, headings: Array) -> Array:
        if self.heading_tolerance is None:
            return inside
        return inside & (np.abs(wrap_angle(poses[:, :, 2] - headings[:, None])) <= self.heading_tolerance)


class _TargetCount(GoalCount):
    """1 while every robot is in the target, else 0."""

    def __init__(self, cases: Sequence[GoalCase]) -> None:
        self.needed = np.ones(len(cases))

    def count(self, transition: Transition) -> FloatArray:
        inside = transition.in_target
        everybody: FloatArray = (inside[:, 0] if inside.shape[1] == 1 else inside.all(axis=1)).astype(
            np.float64
        )
        return everybody


REACH_TARGET: Final = TargetGoal()
"""The goal of a task that names none."""
