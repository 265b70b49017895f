"""Steps seen in a mirror."""


def mirrored_scan(distances):
    """The distances as they are in a mirror; they are given from right
    to left."""
    return distances  # write this


def mirrored_action(action):
    """The action as it is in a mirror: 0 forward, 1 left, 2 right."""
    return action  # write this


def doubled(steps):
    """All steps, each [distances, action, reward, next distances], and
    after them all of them in the mirror."""
    return steps  # write this
