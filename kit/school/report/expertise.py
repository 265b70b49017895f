"""Expertise scores by the dissertation's Algorithm 4, three divisions of a class in two by them, and how much a result depends on
single students."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.plain_text import counted
from kit.school.report.inference import (
    NO_TEST,
    SHUFFLE_COUNT,
    PermutationTestResult,
    correlation,
    correlation_test,
    difference_test,
    non_blank,
)
from kit.school.report.measures import StudentGroup, StudentMeasure

TOPICS: Final = ("robotics", "ros1", "ros2", "simulators", "flatland", "rl")
"""Topics that Algorithm 4 reads, each rated 1 to 7 for the time before the lessons."""

HALF_OF_SCALE: Final = 3.5
MIN_GAP: Final = 0.1
"""A smaller gap between the groups gets a warning: it may be due to rounding."""
MIN_GROUP_SIZE: Final = 5
"""A smaller group gets a warning: it says little about others."""


def expertise_scores(prior: Sequence[StudentMeasure], topics: Mapping[str, str]) -> FloatArray | None:
    """(n,) each student's score; NaN for students who left one of the six topics blank. None where
    a topic has no rating.

    ``topics``: of each measure, by its id.
    """
    ratings = {topics[each.id]: each.values for each in prior}
    if not set(TOPICS) <= set(ratings):
        return None
    ros = np.where(
        np.isnan(ratings["ros1"]) | np.isnan(ratings["ros2"]),
        np.nan,
        np.maximum(ratings["ros1"], ratings["ros2"]),
    )
    return np.asarray(
        _expertise_score({**{topic: ratings[topic] for topic in TOPICS}, "ros": ros}), dtype=np.float64
    )


def _expertise_score(of: Mapping[str, FloatArray]) -> FloatArray:
    """Algorithm 4; ``ros`` is the greater of ROS 1's and ROS 2's rating."""
    overall = sum((of[topic] for topic in TOPICS), np.zeros(())) / len(TOPICS)
    robotics_ros = (of["ros"] + of["robotics"]) / 2
    parts = (of["robotics"], of["ros2"], of["flatland"], of["rl"], of["ros"], robotics_ros, overall)
    score: FloatArray = sum(parts, np.zeros(())) / len(parts)
    return score


def effective_weights() -> tuple[tuple[str, float], ...]:
    """The total weight of each rating in the score, largest first; they add up to 1.

    Several means of means hide this. ``ros`` is the greater of the two ROS ratings.
    """
    inputs = (*TOPICS, "ros")
    weights = [
        (name, float(_expertise_score({other: np.array(float(other == name)) for other in inputs})))
        for name in inputs
    ]
    return tuple(sorted(weights, key=lambda each: -each[1]))


@dataclass(frozen=True, slots=True, eq=False)
class ClassDivision:
    """A class divided in two groups."""

    id: str
    title: str
    beginners: StudentGroup
    experts: StudentGroup
    cut_score: float
    """Students with a lower score are beginners."""
    warnings: tuple[str, ...]

    @property
    def groups(self) -> tuple[StudentGroup, StudentGroup]:
        return self.beginners, self.experts


def divide_class(score: FloatArray, method: str) -> ClassDivision | None:
    """Divides the class by one of the ``DIVISION_METHODS``; None where fewer than two students have a score, or one
    group would be empty."""
    if len(non_blank(score)) < 2:
        return None
    title, find = DIVISION_METHODS[method]
    cut, experts = find(score)
    beginners = ~np.isnan(score) & ~experts
    if not experts.any() or not beginners.any():
        return None
    return ClassDivision(
        method,
        title,
        StudentGroup("beginners", beginners),
        StudentGroup("experts", experts),
        cut,
        tuple(_division_warnings(score, beginners, experts)),
    )


def _split_at(cut: float, score: FloatArray) -> tuple[float, BoolArray]:
    return cut, np.nan_to_num(score, nan=-np.inf) >= cut


def _split_at_half_of_scale(score: FloatArray) -> tuple[float, BoolArray]:
    return _split_at(HALF_OF_SCALE, score)


def _split_at_mean(score: FloatArray) -> tuple[float, BoolArray]:
    return _split_at(float(non_blank(score).mean()), score)


def _split_into_halves(score: FloatArray) -> tuple[float, BoolArray]:
    """The upper half are experts; with an odd number the one in the middle is a beginner. Of equal scores the
    students who come first in the class are experts."""
    order = np.argsort(-np.nan_to_num(score, nan=-np.inf), kind="stable")
    chosen = order[: len(non_blank(score)) // 2]
    experts = np.zeros(len(score), dtype=np.bool_)
    experts[chosen] = True
    return float(score[chosen].min()), experts


DIVISION_METHODS: Final[Mapping[str, tuple[str, Callable[[FloatArray], tuple[float, BoolArray]]]]] = (
    MappingProxyType(
        {
            "scale": ("at 3.5, half of the scale", _split_at_half_of_scale),
            "half": ("into two halves", _split_into_halves),
            "mean": ("at the mean score", _split_at_mean),
        }
    )
)
"""Name of the option -> title and function; the dissertation used ``mean``."""


def _division_warnings(score: FloatArray, beginners: BoolArray, experts: BoolArray) -> list[str]:
    warnings = []
    gap = float(score[experts].min() - score[beginners].max())
    if gap <= 1e-9:
        warnings.append("it cuts through a tie: students with the same score are on both sides")
    elif gap < MIN_GAP:
        warnings.append(f"the best beginner and the least expert are only {gap:.2f} apart")
    for name, members in (("beginner", beginners), ("expert", experts)):
        count = int(members.sum())
        if count < MIN_GROUP_SIZE:
            warnings.append(f"only {counted(count, name)}")
    return warnings


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


def difference_sensitivity(values: FloatArray, division: ClassDivision, seed: int) -> Sensitivity | None:
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


def correlation_sensitivity(x: FloatArray, y: FloatArray, seed: int) -> Sensitivity | None:
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
