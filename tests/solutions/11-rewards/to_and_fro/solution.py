"""A reward."""


def reward(distance, previous_distance, reached, collided):
    return previous_distance - distance + 2.0 * reached - 2.0 * collided - 0.01
