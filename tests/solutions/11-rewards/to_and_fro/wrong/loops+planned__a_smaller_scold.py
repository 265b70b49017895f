"""A reward."""


def reward(distance, previous_distance, reached, collided):
    return (10.0 if distance < previous_distance else 1.0) * (previous_distance - distance) + reached - collided
