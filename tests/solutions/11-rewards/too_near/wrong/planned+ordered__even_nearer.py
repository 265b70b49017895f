"""A reward."""

# Lesson: It drives to the cell beside G and stays there.

def reward(distance, previous_distance, reached, collided):
    return 1.0 / (0.01 + distance) - collided
