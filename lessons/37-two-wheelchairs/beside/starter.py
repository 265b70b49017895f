"""Are two robots side by side?"""

import math

LONGEST = 0.4  # m: a side ray may be this long
# m: by so much the two front rays may differ, and the two at the back
DIFFERENCE = 0.05
NEAR = 0.5  # m: the robots are nearer than this
ANGLE = 0.35  # rad: each angle is off by less than this


def by_rays(left, right):
    """The left robot's two rays to its right and the right one's two to
    its left, each [front, back] -> True or False."""
    return None  # write this


def by_poses(left, right):
    """The poses of the left and of the right robot, each [x, y, theta]
    -> True or False."""
    return None  # write this
