"""A reward."""

# Lesson: Pay for what has changed instead.


def reward(reached):
    return 10.0 * reached
