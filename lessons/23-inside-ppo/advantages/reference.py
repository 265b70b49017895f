"""What the two functions should return, and the cases they are tried on."""


def errors(rewards, values, next_values, terminated, gamma):
    rows = zip(rewards, values, next_values, terminated, strict=True)
    return [reward + (0.0 if over else gamma * after) - before for reward, before, after, over in rows]


def errors_cases(chance):
    yield {
        "rewards": [0.0, 1.0],
        "values": [0.5, 0.8],
        "next_values": [0.8, 0.3],
        "terminated": [False, True],
        "gamma": 0.9,
    }
    for _ in range(25):
        count = chance.randint(1, 6)
        yield {
            "rewards": numbers(chance, count),
            "values": numbers(chance, count),
            "next_values": numbers(chance, count),
            "terminated": [chance.random() < 0.3 for _ in range(count)],
            "gamma": chance.choice((0.5, 0.9, 0.99)),
        }


def advantages(deltas, ended, gamma, lam):
    found, later = [], 0.0
    for delta, over in zip(reversed(deltas), reversed(ended), strict=True):
        later = delta + (0.0 if over else gamma * lam * later)
        found.insert(0, later)
    return found


def advantages_cases(chance):
    yield {"deltas": [1.0, 2.0, 3.0], "ended": [False, False, True], "gamma": 0.9, "lam": 0.5}
    yield {"deltas": [1.0, 2.0, 3.0], "ended": [True, False, False], "gamma": 0.9, "lam": 0.5}
    for _ in range(25):
        count = chance.randint(3, 7)
        yield {
            "deltas": numbers(chance, count),
            "ended": [chance.random() < 0.3 for _ in range(count)],
            "gamma": chance.choice((0.9, 0.99)),
            "lam": chance.choice((0.5, 0.95)),
        }


def numbers(chance, count):
    return [round(chance.uniform(-2, 2), 2) for _ in range(count)]
