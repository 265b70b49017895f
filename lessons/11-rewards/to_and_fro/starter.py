"""A reward for coming nearer; it never scolds. Mend it."""


def reward(distance, previous_distance, reached, collided):
    """distance, previous_distance: m to the target after and before the
    step. reached, collided: True or False."""
    closer = max(0.0, previous_distance - distance)
    return 10.0 * closer + reached - collided
