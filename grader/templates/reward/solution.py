"""What a step is worth: the way it brought the robot nearer, and how the episode ended."""


def reward(to_go: float, previous_to_go: float, reached: bool, collided: bool) -> float:
    return previous_to_go - to_go - 0.01 + 10.0 * reached - 10.0 * collided
