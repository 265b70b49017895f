"""Pays for being there."""


def reward(reached: bool, collided: bool) -> float:
    return 0.0 if collided else 10.0 if reached else 1.0
