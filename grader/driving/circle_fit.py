"""The circle that comes nearest to a way, and what a student is told of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.arrays import FloatArray

STRAIGHT: Final = 10.0
"""A way whose circle is so many times as large as the asked one is called straight."""
NEAR: Final = 0.1
"""A share of the asked radius: circles that differ less are called alike."""
MIN_POINTS: Final = 10


@dataclass(frozen=True, slots=True)
class CircleFit:
    """The circle that comes nearest to a way."""

    radii: FloatArray
    """(n,) m: how far each point of the way is from the middle."""
    is_left: bool
    """Whether it is driven counter-clockwise."""
    back: float
    """The share of the way, from 0 to 1, that is driven back on the same arc."""

    def off(self, radius: float, turning: str) -> float:
        """Returns how far the way is from a circle of ``radius``, as a share of it; one to the other side counts as one with
        a radius below 0. ``turning``: left, right, or empty for either."""
        radii = self.radii if turning in ("", self._side()) else -self.radii
        return max(float(np.abs(radii - radius).max()) / radius, self.back)

    def _side(self) -> str:
        return "left" if self.is_left else "right"

    def describe(self, radius: float, turning: str) -> str:
        """Returns what is told of a way that should be a circle of ``radius``."""
        asked = f"{radius:g} m" + (f" to the {turning}" if turning else "")
        mean = float(self.radii.mean())
        if mean > STRAIGHT * radius:
            return f"Its way is nearly straight; a circle of {asked} is asked for."
        about = f"Its way is nearest to a circle of {mean:.2g} m to the {self._side()}"
        if self.back > NEAR:
            return f"{about}, and {100 * self.back:.0f} % of it is driven back on the same arc."
        if abs(mean - radius) <= NEAR * radius and turning in ("", self._side()):
            worst = float(np.abs(self.radii - radius).max())
            return f"{about}, as it should be, but it strays from that by up to {worst:.2g} m."
        return f"{about}; {asked} is asked for."


def fit_circle(path: FloatArray) -> CircleFit | None:
    """Returns the circle nearest to a (n, 2) path [m]; None if it is too short, or goes nowhere."""
    if len(path) < MIN_POINTS:
        return None
    # Kasa's fit: x2 + y2 = 2 a x + 2 b y + c is linear in the middle (a, b).
    rows = np.column_stack((2 * path, np.ones(len(path))))
    (a, b, _), *_ = np.linalg.lstsq(rows, (path**2).sum(axis=1), rcond=None)
    spokes = path - (a, b)
    crosses = spokes[:-1, 0] * spokes[1:, 1] - spokes[:-1, 1] * spokes[1:, 0]
    if not np.any(crosses):
        return None
    back = 1.0 - abs(crosses.sum()) / np.abs(crosses).sum()
    return CircleFit(
        np.hypot(spokes[:, 0], spokes[:, 1]), math.copysign(1.0, crosses.sum()) > 0.0, float(back)
    )
