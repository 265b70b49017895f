"""A reward."""

# Lesson: Pay for what has changed instead.


def reward(reached, distance):
    return 10.0 * reached - 1e-9 * distance
