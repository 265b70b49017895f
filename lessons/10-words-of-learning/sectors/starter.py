"""What the agent sees, and when its episode is over."""

import math

FAR = 2.0  # m: nothing is farther than this for the agent
ARRIVED = 0.2  # m: nearer than this to the target it has arrived
MAX_STEPS = 200


def sectors(ranges):
    """91 ranges [m] -> a list of nine: the nearest range of each sector,
    at most FAR.

    Sectors 0 to 7 have ten rays each, the last one has the eleven that
    are left. A ray that met nothing is nan.
    """
    return [FAR] * 9  # write this


def ended(touching, to_target, steps):
    """Whether anything touches the robot, metres to the target, steps so
    far -> [terminated, truncated]."""
    return [False, False]  # write this
