"""What the two functions should return, and the cases they are tried on."""

import math


def by_rays(left, right):
    return all(a <= 0.4 and b <= 0.4 and abs(a - b) <= 0.05 for a, b in zip(left, right, strict=True))


def by_rays_cases(chance):
    yield {"left": [0.3, 0.3], "right": [0.3, 0.3]}
    yield {"left": [0.3, 0.3], "right": [0.3, 0.38]}
    yield {"left": [0.9, 0.9], "right": [0.9, 0.9]}
    yield {"left": [0.3, 0.6], "right": [0.32, 0.6]}
    for _ in range(40):
        left = [chance.choice((chance.uniform(0.1, 0.4), chance.uniform(0.1, 0.6))) for _ in range(2)]
        off = chance.choice((0.03, 0.1))
        yield {"left": left, "right": [each + chance.uniform(-off, off) for each in left]}


def by_poses(left, right):
    dx, dy = right[0] - left[0], right[1] - left[1]
    apart = abs(math.remainder(left[2] - right[2], math.tau))
    abeam = abs(math.remainder(math.atan2(dy, dx) - (left[2] - math.pi / 2), math.tau))
    return math.hypot(dx, dy) < 0.5 and apart < 0.35 and abeam < 0.35


def by_poses_cases(chance):
    yield {"left": [0.0, 0.4, 0.0], "right": [0.0, 0.0, 0.0]}
    yield {"left": [0.0, -0.4, 0.0], "right": [0.0, 0.0, 0.0]}
    yield {"left": [0.0, -0.4, 3.1], "right": [0.0, 0.0, -3.1]}
    for _ in range(60):
        theta, way = chance.uniform(-math.pi, math.pi), chance.choice((0.2, 0.35, 0.45, 0.8))
        side = (
            theta
            - math.pi / 2
            + chance.choice((chance.uniform(-0.3, 0.3), math.pi, chance.uniform(0.4, 1.5)))
        )
        x, y = chance.uniform(-3, 3), chance.uniform(-3, 3)
        other = math.remainder(theta + chance.choice((chance.uniform(-0.3, 0.3), 0.6, math.pi)), math.tau)
        yield {"left": [x, y, theta], "right": [x + way * math.cos(side), y + way * math.sin(side), other]}
