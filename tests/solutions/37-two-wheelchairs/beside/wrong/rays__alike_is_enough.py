"""Are two robots side by side?"""

# Lesson: all four are at most 0.4 m long

import math

LONGEST = 0.4  # m: a side ray may be this long
DIFFERENCE = 0.05  # m: by so much the two front rays may differ, and the two at the back
NEAR = 0.5  # m: the robots are nearer than this
ANGLE = 0.35  # rad: each angle is off by less than this


def by_rays(left, right):
    """The left robot's two rays to its right and the right one's two to its left, each [front, back] -> True or False."""
    pairs = list(zip(left, right))
    return all(abs(a - b) <= DIFFERENCE for a, b in pairs)


def by_poses(left, right):
    """The poses of the left and of the right robot, each [x, y, theta] -> True or False."""
    dx, dy = right[0] - left[0], right[1] - left[1]
    apart = abs(math.remainder(left[2] - right[2], math.tau))
    abeam = abs(math.remainder(math.atan2(dy, dx) - (left[2] - math.pi / 2), math.tau))
    return math.hypot(dx, dy) < NEAR and apart < ANGLE and abeam < ANGLE
