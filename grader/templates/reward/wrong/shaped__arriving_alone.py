"""Pays for arriving and tells nothing on the way."""


def reward(reached: bool) -> float:
    return 10.0 * reached
