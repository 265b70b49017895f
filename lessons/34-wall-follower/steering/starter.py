"""What a wall follower needs of each scan."""

DISTANCE = 0.4  # m from the laser to the wall
SECONDS = 0.1  # from one scan to the next
LIMIT = 1.2  # rad/s


def distance(ranges, side):
    """The nearest range [m] on a side, "right" or "left"; 10.0 if no ray
    there met anything.

    There are 91 rays, from straight behind over the right (ray 22),
    ahead (ray 45) and the left to straight behind.
    """
    return 10.0  # write this


def rate(error, error_before, side):
    """The rate of turning [rad/s], positive to the left, of a robot that
    follows a wall on a side.

    error: DISTANCE less the distance [m]; error_before: that of the scan
    before, None at the first.
    """
    return 0.0  # write this
