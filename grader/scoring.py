"""Partial credit between two anchors, the status of a failure, and the probability that a good work fails by bad luck."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from kit.host.failure import Failure, FailureKind
from kit.results.grading_result import CriterionStatus


@dataclass(frozen=True, slots=True)
class Anchors:
    """The measure that earns nothing, and the one that earns everything. Either may be the larger."""

    none: float
    full: float

    def share(self, measure: float) -> float:
        """Returns the share of points that a measure earns, 0 to 1. NaN earns nothing.

        Only a comparison that holds gives credit, so that NaN cannot slip through.
        """
        if self.full >= self.none:
            if measure >= self.full:
                return 1.0
            return (measure - self.none) / (self.full - self.none) if measure > self.none else 0.0
        if measure <= self.full:
            return 1.0
        return (self.none - measure) / (self.none - self.full) if measure < self.none else 0.0


DEFAULT_STEPS: Final = 4
"""The steps in which points are paid that depend on secret seeds, where the assignment states none."""


MAX_SHARE_STEPS: Final = 20
"""The most steps that an assignment may state: more would carry a measure out, digit by digit."""


def round_share(share: float, steps: int) -> float:
    """Rounds a share of points, 0 to 1, to the nearest of ``steps`` equal steps; only a full share earns everything."""
    if share >= 1.0:
        return 1.0
    return min(max(0, math.ceil(share * steps - 0.5)), steps - 1) / steps


def required_passes(count: int, need: float) -> int:
    """Returns how many of ``count`` episodes must pass for a share ``need`` of them."""
    return min(count, max(0, math.ceil(need * count - 1e-9)))


def unfair_fail_probability(success: float, count: int, passes: int) -> float:
    """Returns the probability that a work which succeeds with probability ``success`` passes fewer than ``passes`` of ``count``.

    The exact binomial sum.
    """
    return math.fsum(
        math.comb(count, k) * success**k * (1.0 - success) ** (count - k)
        for k in range(min(passes, count + 1))
    )


STATUS_BY_FAILURE: Final[Mapping[FailureKind, CriterionStatus]] = MappingProxyType(
    {
        FailureKind.TIMEOUT: CriterionStatus.TIMEOUT,
        FailureKind.MEMORY: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.DISK: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.KILLED: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.FLOOD: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.PROTOCOL: CriterionStatus.PROTOCOL_ERROR,
        FailureKind.CONFINEMENT: CriterionStatus.GRADER_ERROR,
    }
)
"""The status that a failure of the program gives a criterion; any other kind is a student error."""


def status_of_failure(failure: Failure | None) -> CriterionStatus:
    """Returns the status of a criterion that earns nothing, by how the program failed; None if it did not."""
    return (
        CriterionStatus.FAIL
        if failure is None
        else STATUS_BY_FAILURE.get(failure.kind, CriterionStatus.STUDENT_ERROR)
    )
