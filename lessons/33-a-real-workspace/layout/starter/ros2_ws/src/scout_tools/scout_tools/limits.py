"""How fast the scout may drive."""

FASTEST = 0.3


def limited(speed):
    """The speed, no more than FASTEST either way [m/s]."""
    return max(-FASTEST, min(speed, FASTEST))
