"""The directions in which agents look: those of the 91 rays of their lidars."""

from __future__ import annotations

import math

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
