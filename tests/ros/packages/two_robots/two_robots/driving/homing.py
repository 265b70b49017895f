from math import pi


def steer(heading):
    """Turns towards pi / 2."""
    return 2.0 * (pi / 2 - heading)
