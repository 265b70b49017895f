"""Partial credit between two anchors, and the odds of bad luck."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.scoring import Anchors, required_passes, unfair_fail_probability
from tests.cases import every_case


@pytest.mark.parametrize("measure", [math.nan])
@pytest.mark.parametrize("anchors", [Anchors(0, 1), Anchors(1, 0), Anchors(1, 1)])
def test_no_number_earns_nothing(anchors: Anchors, measure: float) -> None:
    assert anchors.share(measure) == 0.0


@every_case(
    ("anchors", "measure", "share"),
    [
        (Anchors(0, 1), 0.25, 0.25),
        (Anchors(0, 1), math.inf, 1.0),
        (Anchors(0, 1), -math.inf, 0.0),
        (Anchors(60, 20), 40.0, 0.5),
        (Anchors(60, 20), math.inf, 0.0),
        (Anchors(60, 20), 5.0, 1.0),
        (Anchors(3, 3), 3.0, 1.0),
        (Anchors(3, 3), 2.9, 0.0),
    ],
)
def test_a_straight_line_between_the_anchors(anchors: Anchors, measure: float, share: float) -> None:
    assert anchors.share(measure) == pytest.approx(share)


@given(st.floats(-10, 10), st.floats(-10, 10), st.floats(allow_nan=True))
def test_a_share_is_a_share(none: float, full: float, measure: float) -> None:
    assert 0.0 <= Anchors(none, full).share(measure) <= 1.0


@every_case(
    ("success", "count", "passes", "odds"),
    [
        (0.95, 10, 9, 0.086),
        (0.95, 20, 18, 0.075),
        (0.95, 50, 45, 0.038),
        (0.75, 100, 70, 0.104),
        (1.0, 10, 10, 0.0),
    ],
)
def test_the_odds_are_binomial(success: float, count: int, passes: int, odds: float) -> None:
    assert unfair_fail_probability(success, count, passes) == pytest.approx(odds, abs=6e-4)


def test_a_share_of_episodes_as_a_count() -> None:
    assert [
        required_passes(10, 0.9),
        required_passes(3, 0.9),
        required_passes(10, 0.3),
        required_passes(5, 0.0),
    ] == [
        9,
        3,
        3,
        0,
    ]
