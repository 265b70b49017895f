"""Measures whether two wheelchairs are side by side, in the dissertation's two ways (section 4.1.2), and how nearly.

The first equation of the geometric answer needs repair: 4.5 takes the arctangent of a quotient, which is undefined
one above the other and cannot tell left from right, and 4.4 and 4.6 subtract angles that wrap round.
Arrays of any leading shape; lengths in metres, angles in radians.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from kit.geometry import wrap_angle

Array: TypeAlias = Any
"""A numpy array, or numpy's number where nothing is left of the shape."""

SIDE_RAYS: Final = ((45 - 21, 45 - 25), (45 + 21, 45 + 25))
"""Of 91 rays, with which two the left and the right robot look at each other: a little ahead of abeam and a little
behind (figure 4.8)."""
MAX_SIDE_RANGE: Final = 0.4
"""Longest side ray [m] of robots that are side by side."""
MAX_RANGE_DIFFERENCE: Final = 0.05
"""Largest difference [m] between the two side rays of a pair."""


@dataclass(frozen=True, slots=True)
class AdjacencyThresholds:
    """Limits of the geometric test [m, rad]; the dissertation names none."""

    distance: float = 0.5
    angle: float = 0.35


def is_adjacent_by_poses(
    left: ArrayLike, right: ArrayLike, thresholds: AdjacencyThresholds = AdjacencyThresholds()
) -> Array:
    """(...) bool, of poses (..., 3): near, facing the same way, and abeam, the left one on the left (4.3, 4.4, 4.6).

    With the arctangent of two arguments and wrapped angles, so that it holds in every direction.
    """
    one, other = np.asarray(left, dtype=float), np.asarray(right, dtype=float)
    dx, dy = other[..., 0] - one[..., 0], other[..., 1] - one[..., 1]
    apart = np.abs(wrap_angle(one[..., 2] - other[..., 2]))
    abeam = np.abs(wrap_angle(np.arctan2(dy, dx) - (one[..., 2] - np.pi / 2)))
    return (np.hypot(dx, dy) < thresholds.distance) & (apart < thresholds.angle) & (abeam < thresholds.angle)


def is_adjacent_by_rays(left: ArrayLike, right: ArrayLike) -> Array:
    """(...) bool, of side rays (..., 2), the front one first: all short, and the pairs alike (4.7 to 4.9).

    What a robot can see by itself. Two walls at the same distance look the same to it.
    """
    one, other = np.asarray(left, dtype=float), np.asarray(right, dtype=float)
    short = (one <= MAX_SIDE_RANGE) & (other <= MAX_SIDE_RANGE)
    return (short & (np.abs(one - other) <= MAX_RANGE_DIFFERENCE)).all(axis=-1)


def adjacency_score(left: ArrayLike, right: ArrayLike) -> Array:
    """(...) 0 to 1, of poses (..., 3): 1 where each is straight abeam of the other and both face the same way.

    exp(-(a / 0.08 m)^2 - (h / 0.4 rad)^2), a: how far each is ahead of or behind the other, on average; h: the angle
    between them. Smooth, so that a learner sees which way is better before the answer is yes.
    """
    one, other = np.asarray(left, dtype=float), np.asarray(right, dtype=float)
    dx, dy = other[..., 0] - one[..., 0], other[..., 1] - one[..., 1]
    ahead = [np.abs(np.cos(each[..., 2]) * dx + np.sin(each[..., 2]) * dy) for each in (one, other)]
    apart = wrap_angle(one[..., 2] - other[..., 2])
    return np.exp(-(((ahead[0] + ahead[1]) / (2 * 0.08)) ** 2) - (apart / 0.4) ** 2)
