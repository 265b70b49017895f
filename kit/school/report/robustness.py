"""How much of a result rests on one student: the same result without each of them in turn."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.kernels.arrays import BoolArray, Float64Array
from kit.school.report.expertise import Division
from kit.school.report.inference import (
    NO_TEST,
    SHUFFLES,
    Chance,
    correlation,
    correlation_test,
    difference_test,
)

LEVEL: Final = 0.05
"""The p value that readers take for a line, for better or worse."""
MOST_TESTED: Final = 60
"""Students up to whom p is looked at without each of them."""
FEWEST: Final = 4


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A result without one student."""

    student: int
    """His or her place in the class, from 0."""
    value: float
    chance: Chance


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """A result, and the same without each student."""

    value: float
    chance: Chance
    without: tuple[LeftOut, ...]

    @property
    def least(self) -> LeftOut:
        return min(self.without, key=lambda each: each.value)

    @property
    def greatest(self) -> LeftOut:
        return max(self.without, key=lambda each: each.value)

    @property
    def turning(self) -> tuple[LeftOut, ...]:
        """Those without whom p is on the other side of 0.05."""
        return tuple(
            each
            for each in self.without
            if not math.isnan(each.chance.p) and (each.chance.p < LEVEL) != (self.chance.p < LEVEL)
        )


def of_difference(values: Float64Array, division: Division, seed: int) -> Sensitivity | None:
    """Experts' mean minus beginners'. The groups stay as they are. None where a group has nobody to spare."""
    first, second = division.experts.members, division.beginners.members
    counted = ~np.isnan(values)
    if min((first & counted).sum(), (second & counted).sum()) < 2:
        return None

    def gap(kept: BoolArray) -> float:
        return float(values[first & kept].mean() - values[second & kept].mean())

    def test(kept: BoolArray, shuffles: int) -> Chance:
        rng = np.random.default_rng(seed)
        return difference_test(values[first & kept], values[second & kept], rng, shuffles)

    return _leave_out(counted & (first | second), gap, test)


def of_correlation(x: Float64Array, y: Float64Array, seed: int) -> Sensitivity | None:
    """Of Pearson's r; None below four pairs, or where one quantity does not vary."""
    both = ~(np.isnan(x) | np.isnan(y))
    if both.sum() < FEWEST or math.isnan(correlation(x, y)):
        return None

    def test(kept: BoolArray, shuffles: int) -> Chance:
        return correlation_test(x[kept], y[kept], np.random.default_rng(seed), shuffles)

    return _leave_out(both, lambda kept: correlation(x[kept], y[kept]), test)


def _leave_out(
    members: BoolArray, value: Callable[[BoolArray], float], test: Callable[[BoolArray, int], Chance]
) -> Sensitivity:
    # Fewer in a large class, where this is asked as often as it has students.
    shuffles = max(1000, 100_000 // int(members.sum()))
    without = {}
    for student in np.flatnonzero(members):
        kept = members.copy()
        kept[student] = False
        found = value(kept)
        if not math.isnan(found):
            without[int(student)] = (found, kept)
    by_value = sorted(without, key=lambda student: without[student][0])
    # In a large class only the extremes are worth a test: nobody else can move p as far.
    tested = set(without) if len(without) <= MOST_TESTED else {by_value[0], by_value[-1]}
    return Sensitivity(
        value(members),
        test(members, SHUFFLES),
        tuple(
            LeftOut(student, found, test(kept, shuffles) if student in tested else NO_TEST)
            for student, (found, kept) in without.items()
        ),
    )
