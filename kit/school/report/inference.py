"""Statistics for small samples: summaries, intervals, and permutation tests that are exact for small groups.

The tests need no distribution: they compare what was seen with what every other division of the same numbers into
groups of the same size would have shown (R. A. Fisher, The Design of Experiments, 1935; E. J. G. Pitman, Supplement to
the Journal of the Royal Statistical Society 4, 1937). Student's t for intervals of means is computed here in forty
lines: nothing else in the kit needs scipy, and the core must install in seconds.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache
from itertools import combinations, permutations
from statistics import NormalDist
from typing import Final, NamedTuple

import numpy as np

from kit.arrays import FloatArray
from kit.learning.policies.confidence_intervals import ConfidenceInterval

SHUFFLE_COUNT: Final = 20_000
"""Number of random rearrangements sampled where all of them are too many."""
MAX_SPLITS: Final = 200_000
MAX_PERMUTED: Final = 8
"""Largest number of values of which all orders are computed: 8! = 40,320."""
MAX_DENOMINATOR: Final = 2520
"""The least common multiple of 1 to 10: means of up to ten whole numbers are multiples of one over it."""
MAX_COUNTED: Final = 400
"""Numbers up to which splits are counted instead of shuffled; beyond, a float could not hold the counts."""

MAX_ADDITIONS: Final = 5e7
"""Additions for counting one test's splits."""
SHUFFLE_CHUNK: Final = 2_000_000
"""Numbers in memory while shuffling."""

_TOLERANCE: Final = 1e-9


class SummaryStatistics(NamedTuple):
    """Summary statistics of a group; NaN where there are too few values."""

    n: int
    mean: float
    sd: float
    """Sample standard deviation, divided by n - 1."""
    interval: ConfidenceInterval
    """95 percent interval of the mean, by Student's t."""


class PermutationTestResult(NamedTuple):
    """The result of a permutation test."""

    p_value: float
    """Two-sided p-value; NaN where nothing can be compared."""
    arrangements: int
    """Number of arrangements that were computed."""
    is_exact: bool
    """Whether those are all possible arrangements."""


NO_TEST: Final = PermutationTestResult(math.nan, 0, is_exact=True)


def non_blank(values: FloatArray) -> FloatArray:
    """The values without NaN."""
    kept: FloatArray = values[~np.isnan(values)]
    return kept


def summary_statistics(values: FloatArray) -> SummaryStatistics:
    """Summary statistics of the values that are not NaN."""
    kept = non_blank(values)
    n = len(kept)
    mean = float(kept.mean()) if n else math.nan
    if n < 2:
        return SummaryStatistics(n, mean, math.nan, ConfidenceInterval(math.nan, math.nan))
    sd = float(kept.std(ddof=1))
    half = t_quantile(0.975, n - 1) * sd / math.sqrt(n)
    return SummaryStatistics(n, mean, sd, ConfidenceInterval(mean - half, mean + half))


@cache
def t_quantile(share: float, freedom: int) -> float:
    """The value below which a share (of 0.5 to 1) of Student's t distribution lies."""
    if not (0.5 <= share < 1 and freedom >= 1):
        raise ValueError(f"no quantile {share:g} of Student's t with {freedom} degrees of freedom")
    low, high = 0.0, 1.0
    while t_cdf(high, freedom) < share:
        high *= 2
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if t_cdf(middle, freedom) < share else (low, middle)
    return (low + high) / 2


def t_cdf(t: float, freedom: int) -> float:
    """The share of Student's t distribution below ``t`` >= 0."""
    return 1 - 0.5 * _regularised_beta(freedom / (freedom + t * t), freedom / 2, 0.5)


def _regularised_beta(x: float, a: float, b: float) -> float:
    """The regularised incomplete beta function, by its continued fraction (Abramowitz and Stegun 26.5.8)."""
    if x <= 0 or x >= 1:
        return float(x >= 1)
    if x > (a + 1) / (a + b + 2):
        return 1 - _regularised_beta(1 - x, b, a)
    front = math.exp(
        math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)
    )
    # From the innermost term outwards. It takes about the root of a or b many; these are more than enough.
    value = 1.0
    for k in range(60 + 2 * int(math.sqrt(max(a, b))), 0, -1):
        m = k // 2
        if k % 2:
            term = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        else:
            term = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        value = 1 + term / value
    return front / (a * value)


def difference_test(
    first: FloatArray, second: FloatArray, rng: np.random.Generator, shuffles: int = SHUFFLE_COUNT
) -> PermutationTestResult:
    """Tests whether two groups' means differ more than random divisions of the pooled values would.

    Every division of the pooled values into groups of these sizes is counted: by sums where the values are multiples
    of one small fraction, as ratings and scores are; else one by one; with very many, at random from ``rng``.
    """
    first, second = non_blank(first), non_blank(second)
    k, pooled = len(first), np.concatenate((first, second))
    if not k or not len(second):
        return NO_TEST
    expected = pooled.sum() * k / len(pooled)
    seen = abs(first.sum() - expected) - _TOLERANCE * max(1.0, float(np.abs(pooled).sum()))
    whole = _as_integers(pooled)
    if whole is not None and _can_count(whole, k):
        sums, counts = _subset_sums(whole, k)
        unit = float(pooled.sum()) / whole.sum() if whole.sum() else 0.0
        far = np.abs(sums * unit - expected) >= seen
        return PermutationTestResult(
            float(counts[far].sum() / counts.sum()), math.comb(len(pooled), k), is_exact=True
        )
    if math.comb(len(pooled), k) <= MAX_SPLITS:
        splits = np.array([pooled[list(chosen)].sum() for chosen in combinations(range(len(pooled)), k)])
        return PermutationTestResult(
            float(np.mean(np.abs(splits - expected) >= seen)), len(splits), is_exact=True
        )
    weights = np.zeros(len(pooled))
    weights[:k] = 1
    return _sampled_result(np.abs(_shuffled_sums(pooled, weights, rng, shuffles) - expected) >= seen)


def paired_test(differences: FloatArray, rng: np.random.Generator) -> PermutationTestResult:
    """Tests whether the sum of differences within pairs is farther from 0 than with random signs."""
    there = non_blank(differences)
    if not len(there):
        return NO_TEST
    sizes, total = np.abs(there), float(np.abs(there).sum())
    seen = abs(float(there.sum())) - _TOLERANCE * max(1.0, total)
    whole = _as_integers(sizes) if len(there) <= MAX_COUNTED else None
    if whole is not None:
        counts = np.zeros(int(whole.sum()) + 1)
        counts[0] = 1
        for number in whole.astype(np.int64):
            counts[number:] += counts[: len(counts) - number].copy()
        sums = (2 * np.arange(len(counts)) / whole.sum() - 1) * total
        return PermutationTestResult(
            float(counts[np.abs(sums) >= seen].sum() / counts.sum()), 2 ** len(there), is_exact=True
        )
    if not total:
        return PermutationTestResult(1.0, 2 ** len(there), is_exact=True)
    signs = rng.choice((-1.0, 1.0), size=(SHUFFLE_COUNT, len(there)))
    return _sampled_result(np.abs(signs @ sizes) >= seen)


def _shuffled_sums(
    values: FloatArray, weights: FloatArray, rng: np.random.Generator, times: int
) -> FloatArray:
    """(times,) weighted sums of the values in random orders."""
    rows = max(1, SHUFFLE_CHUNK // len(values))
    parts = [
        rng.permuted(np.tile(values, (min(rows, times - start), 1)), axis=1) @ weights
        for start in range(0, times, rows)
    ]
    return np.concatenate(parts)


def _can_count(whole: FloatArray, k: int) -> bool:
    """Whether the sums of all splits can be counted quickly and without overflow of a float."""
    small = min(k, len(whole) - k)
    unit = max(1, int(np.gcd.reduce(whole.astype(np.int64))))
    return (
        len(whole) <= MAX_COUNTED and len(whole) * small * small * float(whole.max()) / unit <= MAX_ADDITIONS
    )


def _as_integers(values: FloatArray) -> FloatArray | None:
    """The values as multiples of a common fraction; None if there is none with a small denominator."""
    fractions = [Fraction(float(value)).limit_denominator(MAX_DENOMINATOR) for value in values]
    unit = math.lcm(*(each.denominator for each in fractions))
    if unit > MAX_DENOMINATOR:
        return None
    whole = np.array([float(each * unit) for each in fractions])
    close = bool(np.all(np.abs(whole / unit - values) < _TOLERANCE))
    return whole if close and whole.sum() and np.all(whole >= 0) and whole.sum() < 1_000_000 else None


def _subset_sums(whole: FloatArray, k: int) -> tuple[FloatArray, FloatArray]:
    """All sums of ``k`` of the numbers, and the number of choices with each sum."""
    small = min(k, len(whole) - k)
    numbers = whole.astype(np.int64)
    common = int(np.gcd.reduce(numbers)) or 1
    numbers //= common
    counts = np.zeros((small + 1, int(np.sort(numbers)[-small:].sum()) + 1 if small else 1))
    counts[0, 0] = 1
    for number in numbers:
        # Rows from the last: each number is taken once at most.
        for taken in range(small, 0, -1):
            counts[taken, number:] += counts[taken - 1, : counts.shape[1] - number]
    sums = np.flatnonzero(counts[small])
    kept: FloatArray = counts[small][sums]
    chosen = sums if small == k else int(numbers.sum()) - sums
    return np.asarray(chosen * common, dtype=np.float64), kept


def correlation(x: FloatArray, y: FloatArray) -> float:
    """Pearson's r of the pairs in which neither is blank; NaN where one does not vary."""
    x, y = _complete_pairs(x, y)
    if len(x) < 3:
        return math.nan
    x, y = x - x.mean(), y - y.mean()
    scale = math.sqrt(float(x @ x) * float(y @ y))
    return float(x @ y) / scale if scale > _TOLERANCE else math.nan


def rank_correlation(x: FloatArray, y: FloatArray) -> float:
    """Spearman's rho of the complete pairs; NaN without any."""
    x, y = _complete_pairs(x, y)
    return correlation(mean_ranks(x), mean_ranks(y)) if len(x) else math.nan


def mean_ranks(values: FloatArray) -> FloatArray:
    """Ranks from 1; equal values get their mean rank."""
    _, place, count = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(count)
    return np.asarray((last - (count - 1) / 2)[place], dtype=np.float64)


def correlation_test(
    x: FloatArray,
    y: FloatArray,
    rng: np.random.Generator,
    shuffles: int = SHUFFLE_COUNT,
) -> PermutationTestResult:
    """Tests whether two quantities correlate (Pearson's r) more than in random orders of one of them."""
    x, y = _complete_pairs(x, y)
    r = correlation(x, y)
    if math.isnan(r):
        return NO_TEST
    x, y = x - x.mean(), y - y.mean()
    seen = abs(r) * math.sqrt(float(x @ x) * float(y @ y)) * (1 - _TOLERANCE)
    if len(y) <= MAX_PERMUTED:
        orders = np.array(list(permutations(y)))
        return PermutationTestResult(float(np.mean(np.abs(orders @ x) >= seen)), len(orders), is_exact=True)
    return _sampled_result(np.abs(_shuffled_sums(y, x, rng, shuffles)) >= seen)


def correlation_interval(r: float, n: int) -> ConfidenceInterval:
    """95 percent, by Fisher's z (Metron 1, 1921); NaN below four pairs."""
    if n < 4 or math.isnan(r):
        return ConfidenceInterval(math.nan, math.nan)
    if abs(r) >= 1 - _TOLERANCE:
        return ConfidenceInterval(r, r)
    half = NormalDist().inv_cdf(0.975) / math.sqrt(n - 3)
    return ConfidenceInterval(math.tanh(math.atanh(r) - half), math.tanh(math.atanh(r) + half))


def fit_polynomial(x: FloatArray, y: FloatArray, degree: int = 1) -> FloatArray | None:
    """Fits a polynomial by least squares; coefficients from the highest power. None for too few distinct x."""
    x, y = _complete_pairs(x, y)
    return np.polyfit(x, y, degree) if len(np.unique(x)) > degree else None


def _complete_pairs(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    kept = ~(np.isnan(x) | np.isnan(y))
    return x[kept], y[kept]


def _sampled_result(far: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> PermutationTestResult:
    """Counts the observed value as one of the arrangements, so that no p is zero (Phipson and Smyth, 2010)."""
    return PermutationTestResult(float((far.sum() + 1) / (len(far) + 1)), len(far), is_exact=False)
