"""Forces of charges on a robot at (x, y). Each function returns [fx,
fy], in newtons.

An intensity above 0 attracts: the force points from the robot to the
charge. Below 0 it repels.
"""

import math


def tension_force(x, y, cx, cy, intensity):
    """A spring from the robot to (cx, cy), by Hooke's law: strength =
    intensity * r. This one is done."""
    return [intensity * (cx - x), intensity * (cy - y)]


def point_force(x, y, cx, cy, intensity):
    """A point charge at (cx, cy), by Coulomb's law: strength = intensity
    / r^2, r the distance."""
    return [0.0, 0.0]  # TODO


def line_force(x, y, ax, ay, bx, by, intensity):
    """A wall from (ax, ay) to (bx, by): as a point charge at the foot of
    the perpendicular from the robot to it.

    Where the foot lies beyond one of the wall's ends there is no force.
    """
    return [0.0, 0.0]  # TODO
