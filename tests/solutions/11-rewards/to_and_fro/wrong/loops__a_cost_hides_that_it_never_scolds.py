"""A reward."""

# Lesson: A robot that goes round in any loop and comes back to where it was must not have earned anything by it.


def reward(distance, previous_distance, reached):
    return max(0.0, previous_distance - distance) - 0.3 + 200.0 * reached
