"""Right but for a memory: it finds out by itself how far the robot was before."""

seen = [0]


def reward(to_go: float, previous_to_go: float, reached: bool, collided: bool) -> float:
    seen[0] += 1
    return previous_to_go - to_go - 0.01 + 10.0 * reached - 10.0 * collided + 1e-9 * (seen[0] % 7)
