"""Shapiro and Wilk's test of whether numbers are drawn from a normal distribution.

After P. Royston, "Remark AS R94", Applied Statistics 44 (1995), for 4 to 5,000 numbers.
"""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import Final

import numpy as np

from kit.arrays import FloatArray

MIN_NUMBERS: Final = 4
MAX_NUMBERS: Final = 5000


def shapiro_wilk(values: FloatArray) -> tuple[float, float]:
    """The statistic W and its p; NaN for too few or too many numbers, or all the same."""
    x = np.sort(values[~np.isnan(values)])
    n = len(x)
    spread = float(((x - x.mean()) ** 2).sum()) if n else 0.0
    if not MIN_NUMBERS <= n <= MAX_NUMBERS or spread <= 0:
        return math.nan, math.nan
    w = min(1.0, float(_order_statistic_weights(n) @ x) ** 2 / spread)
    if w >= 1:
        return 1.0, 1.0
    if n <= 11:
        edge = -2.273 + 0.459 * n
        y = -math.log(edge - math.log1p(-w))
        mean = _cubic_polynomial(n, 0.5440, -0.39978, 0.025054, -0.0006714)
        sd = math.exp(_cubic_polynomial(n, 1.3822, -0.77857, 0.062767, -0.0020322))
    else:
        y, u = math.log1p(-w), math.log(n)
        mean = _cubic_polynomial(u, -1.5861, -0.31082, -0.083751, 0.0038915)
        sd = math.exp(_cubic_polynomial(u, -0.4803, -0.082676, 0.0030302, 0.0))
    return w, 1 - NormalDist().cdf((y - mean) / sd)


def _order_statistic_weights(n: int) -> FloatArray:
    """(n,) of the order statistics, nearly those of least variance."""
    normal = NormalDist()
    m = np.array([normal.inv_cdf((i - 0.375) / (n + 0.25)) for i in range(1, n + 1)])
    square = float(m @ m)
    u = 1 / math.sqrt(n)
    last = m[-1] / math.sqrt(square) + _power_series(u, 0.221157, -0.147981, -2.071190, 4.434685, -2.706056)
    a = np.empty(n)
    if n > 5:
        next_to = m[-2] / math.sqrt(square) + _power_series(
            u, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633
        )
        scale = (square - 2 * m[-1] ** 2 - 2 * m[-2] ** 2) / (1 - 2 * last**2 - 2 * next_to**2)
        a[2:-2] = m[2:-2] / math.sqrt(scale)
        a[1], a[-2] = -next_to, next_to
    else:
        a[1:-1] = m[1:-1] / math.sqrt((square - 2 * m[-1] ** 2) / (1 - 2 * last**2))
    a[0], a[-1] = -last, last
    return a


def _power_series(u: float, *factors: float) -> float:
    return sum(factor * u**power for power, factor in enumerate(factors, 1))


def _cubic_polynomial(u: float, *factors: float) -> float:
    return sum(factor * u**power for power, factor in enumerate(factors))
