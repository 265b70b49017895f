"""A reward."""

# Lesson: Do not cut off the loss.

def reward(distance, previous_distance, reached, collided):
    return 2.0 * max(0.0, previous_distance - distance) + 3.0 * reached - 2.0 * collided - 0.01
