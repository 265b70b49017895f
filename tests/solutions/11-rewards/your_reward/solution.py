"""A reward."""


def reward(to_go, previous_to_go, reached, collided):
    return previous_to_go - to_go - 0.01 + 2.0 * reached - 2.0 * collided
