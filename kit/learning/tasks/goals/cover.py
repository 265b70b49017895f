"""The goal to drive over a share of the floor."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from kit.arrays import BoolArray, FloatArray, IntArray
from kit.kernels import grids
from kit.learning.tasks.goals.goal import Goal, GoalCase, GoalCount
from kit.learning.tasks.transition import Transition
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class CoverGoal(Goal):
    """A share of the floor that can be reached is driven over."""

    share: float = 0.9
    radius: float = 0.15
    """A robot covers what lies within this of its origin [m]."""

    kind: ClassVar[str] = "cover"

    @classmethod
    def read(cls, section: Section) -> Self:
        usual = cls()
        return cls(
            section.number("share", usual.share, above=0, maximum=1),
            section.number("radius", usual.radius, minimum=0.05, maximum=2),
        )

    @property
    def description(self) -> str:
        return f"come within {self.radius:g} m of {self.share:.0%} of the floor"

    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        return _CoverCount(self, cases, n)

    def progress(self, count: float, needed: float) -> str:
        return f"{self.share * count / needed:.0%} of {self.share:.0%} covered"

    def node_facts(self, case: GoalCase) -> dict[str, Any]:
        from kit.learning.maps.batch_floor import FLOOR_CELL

        floor, (x, y) = _floor_to_cover(self, case)
        packed = base64.b64encode(zlib.compress(np.packbits(floor).tobytes(), 9)).decode()
        places = {
            "cell": FLOOR_CELL,
            "origin": [float(x), float(y)],
            "shape": list(floor.shape),
            "floor": packed,
        }
        return {**Goal.node_facts(self, case), **places}


class _CoverCount(GoalCount):
    """The number of cells of the floor that have been covered."""

    def __init__(self, goal: CoverGoal, cases: Sequence[GoalCase], n: int) -> None:
        from kit.learning.maps.batch_floor import FLOOR_CELL

        self._goal, self._cell = goal, FLOOR_CELL
        floors, origins = zip(*(_floor_to_cover(goal, case) for case in cases), strict=True)
        shape = [max(floor.shape[axis] for floor in floors) for axis in (0, 1)]
        self._floors = np.zeros((len(floors), *shape), dtype=np.bool_)
        for whole, floor in zip(self._floors, floors, strict=True):
            whole[: floor.shape[0], : floor.shape[1]] = floor
        self._origins = np.array(origins)
        self._covered = np.zeros((n, *shape), dtype=np.bool_)
        self.needed = goal.share * self._floors.sum(axis=(1, 2))

    def begin(self, which: IntArray, cases: IntArray, poses: FloatArray) -> FloatArray:
        covered, counts = (
            np.zeros((len(which), *self._covered.shape[1:]), dtype=np.bool_),
            np.zeros(len(which)),
        )
        self._mark_covered(cases, poses, covered, counts)
        self._covered[which] = covered
        return counts

    def count(self, transition: Transition) -> FloatArray:
        counts: FloatArray = transition.before.count.copy()
        self._mark_covered(transition.case, transition.pose, self._covered, counts)
        return counts

    def _mark_covered(
        self, cases: IntArray, poses: FloatArray, covered: BoolArray, counts: FloatArray
    ) -> None:
        radius = self._goal.radius
        grids.cover_cells(poses, cases, self._origins, self._cell, self._floors, radius, covered, counts)


def _floor_to_cover(goal: CoverGoal, case: GoalCase) -> tuple[BoolArray, tuple[float, float]]:
    """(rows, columns) the cells that a robot's radius of covering can reach, and the middle of the first one [m]."""
    from kit.learning.maps.batch_floor import hull_radius, hull_width, measure_floor

    batch_map = case.batch_map
    floor = measure_floor(batch_map)
    reached = floor.reached_from(*case.start, hull_width(batch_map)) & (
        floor.clearance > max(hull_radius(batch_map) - goal.radius, 0.0)
    )
    return reached, floor.origin
