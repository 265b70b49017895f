"""A reward."""

# Lesson: Arriving alone tells nothing on the way. Pay each step for what it has changed.


def reward(reached, distance):
    return 10.0 * reached - 1e-9 * distance
