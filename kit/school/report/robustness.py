"""Sensitivity of a result to single students: recomputes it without each student in turn."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.kernels.arrays import BoolArray, Float64Array
from kit.school.report.expertise import ClassDivision
from kit.school.report.inference import (
    NO_TEST,
    SHUFFLE_COUNT,
    PermutationTestResult,
    correlation,
    correlation_test,
    difference_test,
)

SIGNIFICANCE_LEVEL: Final = 0.05
"""The usual threshold of p values."""
MAX_TESTED: Final = 60
"""Largest number of students for which p is recomputed without each of them."""
MIN_PAIRS: Final = 4


@dataclass(frozen=True, slots=True)
class LeaveOneOut:
    """A result without one student."""

    student: int
    """Index of the student in the class, from 0."""
    value: float
    test: PermutationTestResult


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """A result, and the same without each student."""

    value: float
    test: PermutationTestResult
    without: tuple[LeaveOneOut, ...]

    @property
    def lowest(self) -> LeaveOneOut:
        return min(self.without, key=lambda each: each.value)

    @property
    def highest(self) -> LeaveOneOut:
        return max(self.without, key=lambda each: each.value)

    @property
    def decisive(self) -> tuple[LeaveOneOut, ...]:
        """The students without whom p is on the other side of 0.05."""
        return tuple(
            each
            for each in self.without
            if not math.isnan(each.test.p_value)
            and (each.test.p_value < SIGNIFICANCE_LEVEL) != (self.test.p_value < SIGNIFICANCE_LEVEL)
        )


def difference_sensitivity(values: Float64Array, division: ClassDivision, seed: int) -> Sensitivity | None:
    """Sensitivity of experts' mean minus beginners'; the groups stay as they are. None where a group has one member."""
    first, second = division.experts.members, division.beginners.members
    counted = ~np.isnan(values)
    if min((first & counted).sum(), (second & counted).sum()) < 2:
        return None

    def gap(kept: BoolArray) -> float:
        return float(values[first & kept].mean() - values[second & kept].mean())

    def test(kept: BoolArray, shuffles: int) -> PermutationTestResult:
        rng = np.random.default_rng(seed)
        return difference_test(values[first & kept], values[second & kept], rng, shuffles)

    return _leave_out(counted & (first | second), gap, test)


def correlation_sensitivity(x: Float64Array, y: Float64Array, seed: int) -> Sensitivity | None:
    """Sensitivity of Pearson's r; None below four pairs, or where one quantity does not vary."""
    both = ~(np.isnan(x) | np.isnan(y))
    if both.sum() < MIN_PAIRS or math.isnan(correlation(x, y)):
        return None

    def test(kept: BoolArray, shuffles: int) -> PermutationTestResult:
        return correlation_test(x[kept], y[kept], np.random.default_rng(seed), shuffles)

    return _leave_out(both, lambda kept: correlation(x[kept], y[kept]), test)


def _leave_out(
    members: BoolArray,
    value: Callable[[BoolArray], float],
    test: Callable[[BoolArray, int], PermutationTestResult],
) -> Sensitivity:
    # Fewer in a large class, where the test runs once per student.
    shuffles = max(1000, 100_000 // int(members.sum()))
    without = {}
    for student in np.flatnonzero(members):
        kept = members.copy()
        kept[student] = False
        found = value(kept)
        if not math.isnan(found):
            without[int(student)] = (found, kept)
    by_value = sorted(without, key=lambda student: without[student][0])
    # In a large class only the extremes are tested: no other student can change p as much.
    tested = set(without) if len(without) <= MAX_TESTED else {by_value[0], by_value[-1]}
    return Sensitivity(
        value(members),
        test(members, SHUFFLE_COUNT),
        tuple(
            LeaveOneOut(student, found, test(kept, shuffles) if student in tested else NO_TEST)
            for student, (found, kept) in without.items()
        ),
    )
