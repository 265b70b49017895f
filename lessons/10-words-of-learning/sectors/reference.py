"""What the two functions should return, and the cases they are tried on."""

import math

FAR = 2.0
ARRIVED = 0.2
MAX_STEPS = 200


def sectors(ranges):
    parts = [ranges[10 * k : 10 * k + 10] for k in range(8)] + [ranges[80:]]
    return [min(FAR, min((each for each in part if not math.isnan(each)), default=FAR)) for part in parts]


def sectors_cases(chance):
    yield {"ranges": [1.0] * 91}
    yield {"ranges": [0.5 + 0.01 * ray for ray in range(91)]}
    yield {"ranges": [1.5] * 90 + [0.3]}
    for _ in range(30):
        nothing = chance.choice((0.0, 0.1, 0.6))
        yield {
            "ranges": [
                float("nan") if chance.random() < nothing else chance.uniform(0.1, chance.choice((1.5, 9.0)))
                for _ in range(91)
            ]
        }


def ended(touching, to_target, steps):
    terminated = touching or to_target < ARRIVED
    return [terminated, steps >= MAX_STEPS and not terminated]


def ended_cases(chance):
    yield {"touching": False, "to_target": 1.5, "steps": 7}
    yield {"touching": True, "to_target": 1.5, "steps": 31}
    yield {"touching": False, "to_target": 0.1, "steps": 87}
    yield {"touching": False, "to_target": 1.5, "steps": 200}
    for _ in range(30):  # near both bounds too: the answer to a case is not that to the nearest one
        low, high = (0.01, 0.15, 0.201, 0.25), (0.15, 0.199, 0.25, 1.5)
        side = chance.randrange(4)
        yield {
            "touching": chance.random() < 0.25,
            "to_target": round(chance.uniform(low[side], high[side]), 3),
            "steps": chance.choice(
                (chance.randint(1, 189), chance.randint(190, 199), 199, 200, chance.randint(200, 300))
            ),
        }
