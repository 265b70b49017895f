"""Computes Wilson's score interval of a share of successes.

E. B. Wilson, "Probable inference, the law of succession, and statistical inference", Journal of the American
Statistical Association 22 (1927). Unlike the textbook's plus or minus it is right near 0 and 1 too, where learners
end up.
"""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import NamedTuple


class ConfidenceInterval(NamedTuple):
    """Bounds of the true share, 0 to 1."""

    low: float
    high: float


def wilson_interval(successes: int, trials: int, confidence: float = 0.95) -> ConfidenceInterval:
    """The interval that holds the true share with this confidence; (0, 1) before any trial.

    ValueError if the numbers cannot be counts of one another, or the confidence is not between 0 and 1.
    """
    if not 0 <= successes <= trials:
        raise ValueError(f"{successes} of {trials} is not a proportion")
    return _score_interval(successes, trials, NormalDist().inv_cdf(0.5 + _check_confidence(confidence) / 2))


def lower_bound(successes: int, trials: int, confidence: float = 0.95) -> float:
    """The one-sided lower bound of the true share, with this confidence."""
    if not 0 <= successes <= trials:
        raise ValueError(f"{successes} of {trials} is not a proportion")
    return _score_interval(successes, trials, NormalDist().inv_cdf(_check_confidence(confidence))).low


def _check_confidence(confidence: float) -> float:
    if not 0 < confidence < 1:
        raise ValueError(f"a confidence must be between 0 and 1, not {confidence:g}")
    return confidence


def _score_interval(successes: int, trials: int, z: float) -> ConfidenceInterval:
    """``z``: how many standard deviations to either side."""
    if trials == 0:
        return ConfidenceInterval(0.0, 1.0)
    share, z2 = successes / trials, z * z
    middle = (share + z2 / (2 * trials)) / (1 + z2 / trials)
    half = z / (1 + z2 / trials) * math.sqrt(share * (1 - share) / trials + z2 / (4 * trials * trials))
    # The ends are exact where nothing or everything succeeded; rounding must not move them.
    return ConfidenceInterval(
        0.0 if successes == 0 else max(0.0, middle - half),
        1.0 if successes == trials else min(1.0, middle + half),
    )
