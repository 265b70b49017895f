"""Ratings by Bradley and Terry: an independent maximum, and intervals that hold what they claim."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from kit.school.game.league.ratings import MIDDLE, SCALE, rate


def drawn_points(strengths: np.ndarray, games: int, random: np.random.Generator) -> np.ndarray:
    """Points of a tournament in which all meet all ``games`` times. ``strengths``: ln g of each."""
    count = len(strengths)
    points = np.zeros((count, count))
    for first in range(count):
        for second in range(first):
            won = random.binomial(games, 1.0 / (1.0 + np.exp(strengths[second] - strengths[first])))
            points[first, second], points[second, first] = won, games - won
    return points


@pytest.mark.parametrize("seed", range(3))
def test_ratings_are_where_a_general_optimiser_finds_the_maximum(seed: int) -> None:
    random = np.random.default_rng(seed)
    points = drawn_points(random.normal(0.0, 1.5, 6), 5, random)

    def loss(logs: np.ndarray) -> float:
        chances = -np.logaddexp(0.0, logs[None, :] - logs[:, None])
        own = -0.5 * (np.logaddexp(0.0, -logs) + np.logaddexp(0.0, logs))  # a draw against strength 1
        return -float((points * chances).sum() + own.sum())

    found = minimize(loss, np.zeros(6), method="BFGS", options={"gtol": 1e-8}).x
    wanted = MIDDLE + SCALE * (found - found.mean())
    assert [each.points for each in rate(points)] == pytest.approx(wanted.tolist(), abs=0.05)


@pytest.mark.parametrize("games", [6, 30])
def test_intervals_hold_the_true_strength_about_nineteen_times_in_twenty(games: int) -> None:
    random = np.random.default_rng(44)
    held = []
    for _ in range(60):
        strengths = random.normal(0.0, 0.8, 8)
        ratings = rate(drawn_points(strengths, games, random))
        truths = MIDDLE + SCALE * (strengths - strengths.mean())
        held += [each.low <= truth <= each.high for each, truth in zip(ratings, truths, strict=True)]
    assert 0.92 < np.mean(held) < 0.985


def test_who_wins_everything_has_a_finite_rating_and_more_matches_narrow_it() -> None:
    few, many = (rate(np.array([[0.0, games], [0.0, 0.0]])) for games in (1.0, 50.0))
    assert few[0].points > few[1].points
    assert many[0].points > few[0].points
    assert all(np.isfinite((each.points, each.low, each.high)).all() for each in (*few, *many))
    draws = [rate(np.array([[0.0, games], [games, 0.0]]))[0] for games in (1.0, 50.0)]
    assert draws[1].high - draws[1].low < draws[0].high - draws[0].low
    assert rate(np.zeros((0, 0))) == ()
