"""What a wall follower needs of each scan."""

import math

DISTANCE = 0.4  # m from the laser to the wall
SECONDS = 0.1  # from one scan to the next
LIMIT = 1.2  # rad/s


def distance(ranges, side):
    """The nearest range [m] on a side, "right" or "left"; 10.0 if no ray there met anything."""
    rays = ranges[8:37] if side == "right" else ranges[54:83]
    return min((each for each in rays if math.isfinite(each)), default=10.0)


def rate(error, error_before, side):
    """The rate of turning [rad/s], positive to the left, of a robot that follows a wall on a side."""
    change = 0.0 if error_before is None else (error - error_before) / SECONDS
    turn = 4.0 * error + 4.0 * change
    turn = max(-LIMIT, min(LIMIT, turn))
    return turn if side == "right" else -turn
