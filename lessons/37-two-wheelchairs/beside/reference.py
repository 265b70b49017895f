"""What the two functions should return, and the cases they are tried on."""

import math


def by_rays(left, right):
    return all(a <= 0.4 and b <= 0.4 and abs(a - b) <= 0.05 for a, b in zip(left, right, strict=True))


def by_rays_cases(chance):
    yield {"left": [0.3, 0.3], "right": [0.3, 0.3]}
    yield {"left": [0.3, 0.3], "right": [0.3, 0.38]}
    yield {"left": [0.9, 0.9], "right": [0.9, 0.9]}
    yield {"left": [0.3, 0.6], "right": [0.32, 0.6]}
    yield {"left": [0.42, 0.3], "right": [0.38, 0.3]}
    yield {"left": [0.3, 0.38], "right": [0.3, 0.42]}
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
    yield {"left": [0.4, 0.0, -1.57], "right": [0.0, 0.01, -1.57]}
    for number in range(60):
        # Every second pair is side by side; of the others one thing is wrong, or all.
        wrong = (
            set()
            if number % 2
            else set(chance.choice(("way", "side", "heading", "way side heading")).split())
        )
        way = chance.uniform(0.55, 0.9) if "way" in wrong else chance.uniform(0.2, 0.45)
        abeam = (
            chance.choice((math.pi, chance.uniform(0.4, 1.5)))
            if "side" in wrong
            else chance.uniform(-0.3, 0.3)
        )
        apart = chance.choice((0.6, -0.6, math.pi)) if "heading" in wrong else chance.uniform(-0.3, 0.3)
        x, y, theta = chance.uniform(-3, 3), chance.uniform(-3, 3), chance.uniform(-math.pi, math.pi)
        side, other = theta - math.pi / 2 + abeam, math.remainder(theta + apart, math.tau)
        yield {"left": [x, y, theta], "right": [x + way * math.cos(side), y + way * math.sin(side), other]}
