"""Forces of charges on a robot at (x, y). Each function returns [fx, fy], in newtons.

An intensity above 0 attracts: the force points from the robot to the charge. Below 0 it repels.
"""

# Lesson: towards the charge if the intensity is above 0, away from it if below 0

import math


def tension_force(x, y, cx, cy, intensity):
    """A spring from the robot to (cx, cy), by Hooke's law: strength = intensity * r. This one is done."""
    return [intensity * (cx - x), intensity * (cy - y)]


def point_force(x, y, cx, cy, intensity):
    """A point charge at (cx, cy), by Coulomb's law: strength = intensity / r^2, r the distance."""
    dx, dy = cx - x, cy - y
    r = math.hypot(dx, dy)
    strength = -intensity / r**2
    return [strength * dx / r, strength * dy / r]


def line_force(x, y, ax, ay, bx, by, intensity):
    """A wall from (ax, ay) to (bx, by): as a point charge at the foot of the perpendicular from the robot to it.

    Where the foot lies beyond one of the wall's ends there is no force.
    """
    length = math.dist((ax, ay), (bx, by))
    ux, uy = (bx - ax) / length, (by - ay) / length
    along = (x - ax) * ux + (y - ay) * uy
    if along < 0 or along > length:
        return [0.0, 0.0]
    return point_force(x, y, ax + along * ux, ay + along * uy, intensity)
