"""Pays for coming nearer and takes nothing for going away."""


def reward(distance: float, previous_distance: float, reached: bool, collided: bool) -> float:
    return 10.0 * max(0.0, previous_distance - distance) + reached - collided
