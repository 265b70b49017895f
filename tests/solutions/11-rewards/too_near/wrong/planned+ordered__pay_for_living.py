"""A reward."""


def reward(distance, previous_distance, reached, collided):
    return 0.0 if collided else 10.0 if reached else 1.0
