"""A reward that seems fair: the nearer to the target, the more. Mend it.
"""


def reward(distance, previous_distance, reached, collided):
    """distance, previous_distance: m to the target after and before the
    step. reached, collided: True or False."""
    return 1.0 / (1.0 + distance) - collided
