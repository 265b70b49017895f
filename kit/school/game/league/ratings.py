"""Ratings from the results of matches: the model of Bradley and Terry, by maximum likelihood, with intervals.

R. A. Bradley, M. E. Terry: Rank analysis of incomplete block designs, Biometrika 39 (1952) 324-345: the chance that i wins
against j is g_i / (g_i + g_j). D. R. Hunter: MM algorithms for generalized Bradley-Terry models, Annals of Statistics 32
(2004) 384-406, gives the iteration. A draw counts as half a win for both. One draw more for each entrant, against a player of
strength 1, keeps the ratings of those finite who have won, or lost, everything.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.arrays import FloatArray

MIDDLE: Final = 1500.0
"""The mean of all ratings."""
SCALE: Final = 400.0 / math.log(10.0)
"""Points of rating per unit of ln g: 400 points are ten to one, as in chess."""
Z: Final = 1.959964
"""Of a normal distribution, for 95 %."""
TOLERANCE: Final = 1e-12
MAX_ROUNDS: Final = 100_000


@dataclass(frozen=True, slots=True)
class Rating:
    """An entrant's strength, in points."""

    points: float
    low: float
    """The 95 % confidence interval, from the curvature of the likelihood at its maximum (observed information)."""
    high: float


def rate(points: FloatArray) -> tuple[Rating, ...]:
    """The ratings of n entrants. ``points``: (n, n), how many points each entrant of a row has won against that of a column;
    the two of a match share one point.

    >>> first, second = rate(np.array([[0.0, 3.0], [1.0, 0.0]]))
    >>> first.points > second.points, round(first.points + second.points)
    (True, 3000)
    """
    count = len(points)
    if not count:
        return ()
    matches = points + points.T
    won = points.sum(axis=1) + 0.5
    strength = np.ones(count)
    for _ in range(MAX_ROUNDS):
        met = (matches / (strength[:, None] + strength[None, :])).sum(axis=1) + 1.0 / (strength + 1.0)
        better = won / met
        is_still = np.abs(np.log(better / strength)).max() < TOLERANCE
        strength = better
        if is_still:
            break
    chance = strength[:, None] / (strength[:, None] + strength[None, :])
    information = -matches * chance * chance.T
    alone = strength / (strength + 1.0)
    np.fill_diagonal(information, -information.sum(axis=1) + np.diag(information) + alone * (1.0 - alone))
    from_mean = np.eye(count) - 1.0 / count
    spread = from_mean @ np.linalg.inv(information) @ from_mean.T
    logarithms = from_mean @ np.log(strength)
    found = []
    for value, variance in zip(logarithms, np.diag(spread), strict=True):
        middle, half = MIDDLE + SCALE * value, SCALE * Z * math.sqrt(max(0.0, variance))
        found.append(Rating(float(middle), float(middle - half), float(middle + half)))
    return tuple(found)
