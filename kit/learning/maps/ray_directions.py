"""The directions in which agents look: those of the 91 rays of their lidars."""

from __future__ import annotations

import math

import numpy as np

from kit.arrays import Float32Array, FloatArray

RAY_COUNT = 91
"""The robot's lidar: every 4 degrees from straight back round to straight back; ray 45 points ahead."""
AHEAD_RAY = 45


def ray_direction(ray: int) -> float:
    """The direction of a ray from straight ahead, to the left positive [rad]."""
    return math.radians((ray - AHEAD_RAY) * 360.0 / (RAY_COUNT - 1))


BESIDE = (math.radians(60.0), math.radians(120.0))
"""What lies between these directions is beside a robot, to the left or to the right."""
LEFT_RAYS = tuple(ray for ray in range(RAY_COUNT) if BESIDE[0] <= ray_direction(ray) <= BESIDE[1])
RIGHT_RAYS = tuple(RAY_COUNT - 1 - ray for ray in LEFT_RAYS)


def ranges_in_directions(
    directions: FloatArray, ranges: Float32Array, angles: FloatArray, beyond: float
) -> FloatArray:
    """(k,) [m] what a scan has nearest to each of the ``directions`` (k) [rad]; ``beyond`` where it does not look there or sees
    nothing. ``ranges`` (rays) [m] at ``angles`` (rays) [rad], in one frame with the directions."""
    apart = np.abs(np.angle(np.exp(1j * (angles[None, :] - directions[:, None]))))
    nearest = apart.argmin(axis=1)
    known = np.nan_to_num(ranges.astype(np.float64), nan=beyond, posinf=beyond)[nearest]
    found: FloatArray = np.where(apart.min(axis=1) <= math.tau / (RAY_COUNT - 1), known, beyond)
    return found
