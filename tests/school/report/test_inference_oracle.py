"""Every test and interval of the class report against scipy, which the tests alone install."""

from __future__ import annotations

import math
from importlib import import_module
from typing import Any

import numpy as np
import pytest

from kit.arrays import FloatArray
from kit.learning.policies.confidence_intervals import lower_bound, wilson_interval
from kit.school.report.inference import (
    correlation,
    correlation_interval,
    correlation_test,
    difference_test,
    fit_polynomial,
    mean_ranks,
    paired_test,
    rank_correlation,
    summary_statistics,
    t_cdf,
    t_quantile,
)
from kit.school.report.normality import shapiro_wilk

pytestmark = pytest.mark.long
SEEDS = range(12)


@pytest.fixture(scope="module", name="stats")
def scipy_statistics() -> Any:
    """Imported when a test runs, not when tests are collected: it takes a second."""
    return import_module("scipy.stats")


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def a_sample(seed: int, most: int = 9) -> FloatArray:
    """Measurements, or for odd seeds ratings, of which many are equal."""
    random = rng(seed)
    values = random.normal(0.3, 1.0, int(random.integers(4, most)))
    return values.round() + 4 if seed % 2 else values


def test_students_t(stats: Any) -> None:
    for freedom in (1, 2, 5, 17, 300):
        for t in (0.0, 0.1, 0.9, 2.5, 12.0):
            assert t_cdf(t, freedom) == pytest.approx(stats.t.cdf(t, freedom), abs=1e-12)
        for share in (0.5, 0.8, 0.975, 0.9995):
            assert t_quantile(share, freedom) == pytest.approx(
                stats.t.ppf(share, freedom), rel=1e-9, abs=1e-12
            )


def test_the_interval_of_a_mean(stats: Any) -> None:
    for seed in SEEDS:
        values = rng(seed).normal(2.0, 3.0, 4 + seed)
        theirs = stats.ttest_1samp(values, 0.0).confidence_interval(0.95)
        ours = summary_statistics(values)
        assert ours.interval == pytest.approx((theirs.low, theirs.high), rel=1e-9)
        assert ours.sd == pytest.approx(stats.tstd(values), rel=1e-12)


def test_wilsons_intervals(stats: Any) -> None:
    for successes, trials in ((0, 1), (0, 7), (1, 7), (19, 20), (500, 1000), (20, 20)):
        theirs = stats.binomtest(successes, trials).proportion_ci(0.95, method="wilson")
        assert wilson_interval(successes, trials) == pytest.approx((theirs.low, theirs.high), abs=1e-12)
        one_sided = stats.binomtest(successes, trials, alternative="greater").proportion_ci(
            0.95, method="wilson"
        )
        assert lower_bound(successes, trials) == pytest.approx(one_sided.low, abs=1e-12)


def test_two_groups_differ(stats: Any) -> None:
    for seed in SEEDS:
        first, second = a_sample(seed), a_sample(seed + 100) + 0.5
        # Theirs doubles the smaller tail; ours counts what is as far from the mean on either side: one side, twice.
        far = abs(first.mean() - second.mean())
        theirs = stats.permutation_test(
            (first, second),
            lambda a, b, axis: np.abs(a.mean(axis=axis) - b.mean(axis=axis)),
            vectorized=True,
            n_resamples=np.inf,
            alternative="greater",
        )
        assert theirs.statistic == pytest.approx(far)
        ours = difference_test(first, second, rng())
        assert ours.is_exact
        assert ours.p_value == pytest.approx(theirs.pvalue, abs=1e-9)


def test_pairs_differ(stats: Any) -> None:
    for seed in SEEDS:
        differences = np.round(rng(seed).normal(0.4, 1.5, 9))
        theirs = stats.permutation_test(
            (differences,),
            lambda d, axis: np.abs(d.sum(axis=axis)),
            permutation_type="samples",
            vectorized=True,
            n_resamples=np.inf,
            alternative="greater",
        )
        ours = paired_test(differences, rng())
        assert ours.is_exact
        assert ours.p_value == pytest.approx(theirs.pvalue, abs=1e-9)


def test_correlations_and_their_interval(stats: Any) -> None:
    for seed in SEEDS:
        x = rng(seed).normal(size=12)
        y = np.round(x + rng(seed + 50).normal(size=12), 1)
        theirs = stats.pearsonr(x, y)
        assert correlation(x, y) == pytest.approx(theirs.statistic, abs=1e-12)
        interval = theirs.confidence_interval(0.95)
        assert correlation_interval(theirs.statistic, len(x)) == pytest.approx(
            (interval.low, interval.high), abs=1e-9
        )
        assert rank_correlation(x, y) == pytest.approx(stats.spearmanr(x, y).statistic, abs=1e-12)
        assert mean_ranks(y) == pytest.approx(stats.rankdata(y))


def test_a_correlation_by_permutations(stats: Any) -> None:
    for seed in SEEDS:
        x, y = rng(seed).normal(size=6), a_sample(seed * 2, 5)
        y = np.resize(y, 6) + np.arange(6) * 0.01
        theirs = stats.permutation_test(
            (x,),
            lambda a, axis, y=y: np.abs(stats.pearsonr(a, np.broadcast_to(y, a.shape), axis=axis).statistic),
            permutation_type="pairings",
            vectorized=True,
            n_resamples=np.inf,
            alternative="greater",
        )
        ours = correlation_test(x, y, rng())
        assert ours.is_exact
        assert ours.p_value == pytest.approx(theirs.pvalue, abs=1e-9)


def test_large_groups_are_sampled_near_the_exact_p(stats: Any) -> None:
    first, second = rng(1).normal(0.0, 1.0, 60), rng(2).normal(0.35, 1.0, 60)
    ours = difference_test(first, second, rng())
    theirs = stats.ttest_ind(first, second)  # of so many numbers, the two agree
    assert not ours.is_exact
    assert ours.p_value == pytest.approx(theirs.pvalue, abs=4 * math.sqrt(0.25 / ours.arrangements) + 0.005)


def test_shapiro_and_wilk(stats: Any) -> None:
    for n in (4, 5, 6, 11, 12, 50, 500):
        for values in (
            rng(n).normal(size=n),
            rng(n).exponential(size=n),
            np.round(rng(n).normal(3, 1, n)) + 0.0,
        ):
            if len(np.unique(values)) < 2:
                continue
            theirs = stats.shapiro(values)
            statistic, p_value = shapiro_wilk(values)
            assert statistic == pytest.approx(theirs.statistic, abs=2e-4)
            assert p_value == pytest.approx(theirs.pvalue, abs=5e-3)


def test_a_line_through_points(stats: Any) -> None:
    x = rng(3).normal(size=20)
    y = 2 * x - 1 + rng(4).normal(size=20)
    theirs = stats.linregress(x, y)
    assert fit_polynomial(x, y) == pytest.approx((theirs.slope, theirs.intercept), abs=1e-9)
