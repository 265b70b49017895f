from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as some

from kit.learning.policies.confidence_intervals import lower_bound, wilson_interval

COUNTS = some.integers(1, 3000).flatmap(lambda n: some.tuples(some.integers(0, n), some.just(n)))


def test_a_worked_example() -> None:
    """Newcombe 1998, table I: 81 of 263 gives 0.2553 to 0.3662."""
    low, high = wilson_interval(81, 263)
    assert (round(low, 4), round(high, 4)) == (0.2553, 0.3662)


@given(COUNTS, some.floats(0.5, 0.999))
def test_its_ends_solve_the_equation_it_comes_from(counts: tuple[int, int], confidence: float) -> None:
    """At either end the observed share is just as many standard deviations away."""
    successes, trials = counts
    for end in wilson_interval(successes, trials, confidence):
        if 0 < end < 1:
            away = abs(successes / trials - end) / math.sqrt(end * (1 - end) / trials)
            assert math.erf(away / math.sqrt(2)) == pytest.approx(confidence, abs=1e-6)


@given(COUNTS)
def test_it_holds_the_share_and_mirrors(counts: tuple[int, int]) -> None:
    successes, trials = counts
    low, high = wilson_interval(successes, trials)
    assert 0 <= low <= successes / trials <= high <= 1
    other = wilson_interval(trials - successes, trials)
    assert (1 - other.high, 1 - other.low) == pytest.approx((low, high), abs=1e-12)


def test_nothing_tried_tells_nothing() -> None:
    assert wilson_interval(0, 0) == (0.0, 1.0)
    assert lower_bound(0, 0) == 0.0


def test_one_side_alone_is_surer() -> None:
    assert wilson_interval(97, 100).low < lower_bound(97, 100) < 0.97
    assert lower_bound(97, 100) == wilson_interval(97, 100, 0.9).low


@pytest.mark.parametrize("wrong", [(3, 2, 0.9), (-1, 2, 0.9), (1, 2, 1.0), (1, 2, 0.0)])
def test_impossible_numbers_are_refused(wrong: tuple[int, int, float]) -> None:
    with pytest.raises(ValueError, match=r"proportion|confidence"):
        wilson_interval(*wrong)
    with pytest.raises(ValueError, match=r"proportion|confidence"):
        lower_bound(*wrong)
