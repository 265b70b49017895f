"""What the two functions should return, and the cases they are tried on."""

import math


def weigh(expected, measured, spread):
    weights = []
    for distances in expected:
        pairs = [(a, b) for a, b in zip(distances, measured, strict=True) if not math.isnan(b)]
        weights.append(math.prod(math.exp(-((a - b) ** 2) / (2 * spread**2)) for a, b in pairs))
    whole = sum(weights)
    return [weight / whole for weight in weights]


def weigh_cases(chance):
    yield {"expected": [[1.0, 2.0], [1.5, 2.0], [3.0, 2.0]], "measured": [1.0, 2.0], "spread": 0.5}
    yield {"expected": [[1.0, 2.0], [1.5, 9.0]], "measured": [1.2, float("nan")], "spread": 0.5}
    for _ in range(30):
        rays, spread = chance.randint(1, 5), chance.uniform(0.3, 1.0)
        measured = [chance.uniform(0.5, 3.0) for _ in range(rays)]
        expected = [
            [max(0.1, chance.gauss(each, spread)) for each in measured] for _ in range(chance.randint(2, 6))
        ]
        if chance.random() < 0.4 and rays > 1:
            measured[chance.randrange(rays)] = float("nan")
        yield {"expected": expected, "measured": measured, "spread": spread}


def resample(weights, first):
    n, number, end, chosen = len(weights), 0, weights[0], []
    for k in range(n):
        while first + k / n > end and number < n - 1:
            number += 1
            end += weights[number]
        chosen.append(number)
    return chosen


def resample_cases(chance):
    yield {"weights": [0.25, 0.25, 0.25, 0.25], "first": 0.1}
    yield {"weights": [0.0, 0.9, 0.1], "first": 0.2}
    for _ in range(30):
        raw = [chance.random() ** 3 + 0.001 for _ in range(chance.randint(2, 8))]
        weights = [each / sum(raw) for each in raw]
        yield {"weights": weights, "first": chance.uniform(0.01, 0.99) / len(raw)}
