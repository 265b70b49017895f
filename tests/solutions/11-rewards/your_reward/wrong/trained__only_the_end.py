"""A reward."""


def reward(reached, collided):
    return 10.0 * reached - 10.0 * collided - 0.1
