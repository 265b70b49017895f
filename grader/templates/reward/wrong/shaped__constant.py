"""Takes the same for every step, whatever it was."""


def reward(reached: bool) -> float:
    return -1.0
