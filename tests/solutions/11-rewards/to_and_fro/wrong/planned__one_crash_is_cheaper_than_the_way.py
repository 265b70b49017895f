"""A reward."""

# Lesson: The agent adds up the whole episode.


def reward(distance, reached, collided):
    return 5.0 * reached - 1.0 * collided - distance
