"""A reward."""


def reward(distance, previous_distance, reached, collided):
    return 1.0 / (0.01 + distance) - collided
