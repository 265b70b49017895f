"""A reward."""

# Lesson: A robot that goes round in any loop and comes back to where it was must not have earned anything by it.


def reward(move, distance, previous_distance, reached, collided):
    return previous_distance - distance + 2.0 * reached - 2.0 * collided + (0.1 if move > 2 else 0.0)
