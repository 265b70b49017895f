"""Pays for arriving, and next to nothing for the way."""


def reward(reached: bool, distance: float) -> float:
    return 10.0 * reached - 1e-9 * distance
