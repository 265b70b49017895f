"""What the two functions should return, and the cases they are tried on."""

import math


def objective(now, then, advantage, clip):
    ratio = now / then
    near = max(1 - clip, min(1 + clip, ratio))
    return min(ratio * advantage, near * advantage)


def objective_cases(chance):
    yield {"now": 0.5, "then": 0.25, "advantage": -1.0, "clip": 0.2}
    yield {"now": 0.5, "then": 0.25, "advantage": 1.0, "clip": 0.2}
    yield {"now": 0.1, "then": 0.25, "advantage": -1.0, "clip": 0.2}
    for _ in range(40):
        now, then = (round(chance.uniform(0.05, 0.95), 2) for _ in range(2))
        advantage = round(chance.uniform(-2, 2), 2)
        yield {"now": now, "then": then, "advantage": advantage, "clip": chance.choice((0.1, 0.2, 0.3))}


def entropy(chances):
    return -sum(p * math.log(p) for p in chances if p > 0)


def entropy_cases(chance):
    yield {"chances": [0.25, 0.25, 0.25, 0.25]}
    yield {"chances": [0.5, 0.5, 0.0]}
    for _ in range(20):
        weights = [chance.choice((0.0, chance.random(), chance.random())) for _ in range(4)]
        total = sum(weights) or 1.0
        yield {"chances": [weight / total for weight in weights] if sum(weights) else [1.0, 0.0]}
