"""What share of its points a measure earns, and how probably a good work loses them by bad luck."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

DEFAULT_STEPS: Final = 4
"""The steps in which points are paid that depend on secret seeds, where the assignment states none."""
MAX_SHARE_STEPS: Final = 20
"""The most steps that an assignment may state: more would carry a measure out, digit by digit."""


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
