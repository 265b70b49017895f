"""Intervals and tests against counting by hand, against each other, and against published values."""

from __future__ import annotations

import math
from itertools import combinations, permutations, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.arrays import FloatArray
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
from tests.cases import every_case


def rng() -> np.random.Generator:
    return np.random.default_rng(0)


@every_case(
    ("freedom", "t"),
    [(1, 12.7062), (2, 4.30265), (3, 3.18245), (4, 2.77645), (11, 2.20099), (30, 2.04227), (120, 1.97993)],
)
def test_students_t_is_that_of_the_tables(freedom: int, t: float) -> None:
    assert t_quantile(0.975, freedom) == pytest.approx(t, abs=6e-6 * t)
    assert t_cdf(t, freedom) == pytest.approx(0.975, abs=1e-5)


def test_student_of_many_is_normal_and_of_one_is_cauchy() -> None:
    assert t_quantile(0.975, 100_000) == pytest.approx(1.95996, abs=1e-4)
    assert t_cdf(1.0, 1) == pytest.approx(0.75, abs=1e-12)
    assert t_quantile(0.5, 5) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(("share", "freedom"), [(0.4, 3), (1.0, 3), (0.9, 0)])
def test_no_such_quantile(share: float, freedom: int) -> None:
    with pytest.raises(ValueError, match="quantile"):
        t_quantile(share, freedom)


def test_a_summary_leaves_blanks_out() -> None:
    found = summary_statistics(np.array([1.0, math.nan, 3.0, 5.0]))
    assert (found.n, found.mean, found.sd) == (3, 3.0, 2.0)
    half = 4.30265 * 2 / math.sqrt(3)
    assert found.interval == pytest.approx((3 - half, 3 + half), abs=1e-4)


@pytest.mark.parametrize("values", [[], [math.nan], [4.0], [4.0, math.nan]])
def test_too_few_values_have_no_statistics(values: list[float]) -> None:
    found = summary_statistics(np.array(values, dtype=np.float64))
    assert math.isnan(found.sd)
    assert math.isnan(found.interval.low)


def by_hand(first: FloatArray, second: FloatArray, tolerance: float = 1e-9) -> float:
    """``tolerance``: by how much a difference may be smaller than the one seen and still count."""
    pooled = np.concatenate((first, second))

    def gap(chosen: tuple[int, ...]) -> float:
        inside = np.zeros(len(pooled), dtype=bool)
        inside[list(chosen)] = True
        return abs(float(pooled[inside].mean() - pooled[~inside].mean()))

    seen = gap(tuple(range(len(first)))) - tolerance
    return float(np.mean([gap(each) >= seen for each in combinations(range(len(pooled)), len(first))]))


ratings = st.lists(st.integers(1, 7), min_size=1, max_size=5)


@pytest.mark.long
@given(ratings, ratings, st.sampled_from([1, 2, 3, 7, 12]))
def test_sums_count_the_same_splits_as_one_by_one(a: list[int], b: list[int], parts: int) -> None:
    first, second = np.array(a) / parts, np.array(b) / parts
    found = difference_test(first, second, rng())
    assert found.is_exact
    assert found.p_value == pytest.approx(by_hand(first, second), abs=1e-12)
    assert found.p_value == pytest.approx(difference_test(second, first, rng()).p_value, abs=1e-12)


@given(st.lists(st.floats(-5, 5), min_size=2, max_size=4), st.lists(st.floats(-5, 5), min_size=2, max_size=4))
def test_numbers_without_a_common_fraction(a: list[float], b: list[float]) -> None:
    first, second = np.array(a), np.array(b)
    found = difference_test(first, second, rng())
    assert found.is_exact
    # What is as good as a tie may be rounded either way.
    assert by_hand(first, second, -1e-6) <= found.p_value <= by_hand(first, second, 1e-6)


def test_very_many_are_shuffled_and_come_out_alike() -> None:
    values = rng().normal(size=60)
    found = difference_test(values[:30] + 0.4, values[30:], rng())
    assert not found.is_exact
    again = difference_test(values[:30] + 0.4, values[30:], np.random.default_rng(9))
    assert found.p_value == pytest.approx(again.p_value, abs=0.02)
    assert difference_test(values[:30] + 9, values[30:], rng()).p_value > 0


def test_large_classes_are_counted_by_sums() -> None:
    values = rng().integers(1, 8, 60).astype(np.float64)
    found = difference_test(values[:30], values[30:], rng())
    assert found.is_exact
    assert found.arrangements == math.comb(60, 30)
    shuffled = [
        abs(float((order := rng_.permutation(values))[:30].mean() - order[30:].mean()))
        for rng_ in [rng()]
        for _ in range(4000)
    ]
    seen = abs(float(values[:30].mean() - values[30:].mean()))
    assert found.p_value == pytest.approx(np.mean(np.array(shuffled) >= seen - 1e-9), abs=0.04)


def test_all_alike_differ_in_nothing_and_nobody_cannot_be_compared() -> None:
    same = np.full(5, 4.0)
    assert difference_test(same, same, rng()).p_value == 1
    assert difference_test(np.zeros(3), np.zeros(2), rng()).p_value == 1
    assert math.isnan(difference_test(same, np.array([math.nan]), rng()).p_value)


@given(st.lists(st.integers(-6, 6), min_size=1, max_size=8))
def test_paired_differences_by_their_signs(values: list[int]) -> None:
    differences = np.array(values, dtype=np.float64)
    sums = [abs(float(np.dot(signs, np.abs(differences)))) for signs in product((-1, 1), repeat=len(values))]
    expected = np.mean(np.array(sums) >= abs(differences.sum()) - 1e-9)
    assert paired_test(differences, rng()).p_value == pytest.approx(expected, abs=1e-12)


def test_r_of_few_by_every_order() -> None:
    x, y = np.array([1.0, 2, 3, 4, 5]), np.array([2.0, 1, 4, 3, 5])
    found = correlation_test(x, y, rng())
    orders = [abs(correlation(x, np.array(order))) for order in permutations(y)]
    assert found.is_exact
    assert found.p_value == pytest.approx(np.mean(np.array(orders) >= correlation(x, y) - 1e-9))
    assert correlation(x, y) == pytest.approx(0.8)
    assert rank_correlation(x, y**3) == pytest.approx(0.8)


def test_r_needs_pairs_that_vary() -> None:
    line = np.array([1.0, 2, 3, 4])
    assert math.isnan(correlation(line, np.ones(4)))
    assert math.isnan(correlation(line, np.array([1.0, math.nan, math.nan, 2])))
    assert math.isnan(correlation_test(line, np.ones(4), rng()).p_value)
    assert correlation(line, -line) == pytest.approx(-1)
    assert fit_polynomial(np.ones(4), line) is None


def test_equal_values_share_their_rank() -> None:
    assert mean_ranks(np.array([3.0, 1, 3, 2])).tolist() == [3.5, 1, 3.5, 2]


def test_the_interval_of_r_holds_it_and_narrows() -> None:
    few, many = correlation_interval(0.6, 12), correlation_interval(0.6, 120)
    assert few.low < many.low < 0.6 < many.high < few.high < 1
    assert correlation_interval(0.6, 12) == pytest.approx((0.04, 0.87), abs=0.005)
    assert math.isnan(correlation_interval(0.6, 3).low)
