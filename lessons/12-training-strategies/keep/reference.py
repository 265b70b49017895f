"""What the two functions should return, and the cases they are tried on."""

import math

Z = 1.645


def at_least(reached, episodes):
    p, n = reached / episodes, episodes
    middle = p + Z * Z / (2 * n)
    half = Z * math.sqrt(p * (1 - p) / n + Z * Z / (4 * n * n))
    return max(0.0, (middle - half) / (1 + Z * Z / n))


def at_least_cases(chance):
    yield {"reached": 4, "episodes": 4}
    yield {"reached": 95, "episodes": 100}
    yield {"reached": 0, "episodes": 10}
    for _ in range(30):
        episodes = chance.choice((1, 5, 20, 100, 1000))
        yield {"reached": chance.randint(0, episodes), "episodes": episodes}


def keep(tests):
    return max(range(len(tests)), key=lambda k: (min(round(at_least(*case), 9) for case in tests[k]), k))


def keep_cases(chance):
    yield {"tests": [[[4, 4], [4, 4]], [[95, 100], [96, 100]]]}
    yield {"tests": [[[100, 100], [50, 100]], [[80, 100], [78, 100]], [[79, 100], [60, 100]]]}
    yield {"tests": [[[90, 100], [90, 100]], [[90, 100], [90, 100]]]}
    for _ in range(30):
        sizes = [chance.choice((4, 20, 100)) for _ in range(chance.randint(2, 5))]
        yield {"tests": [[[chance.randint(n // 2, n), n] for _ in range(2)] for n in sizes]}
