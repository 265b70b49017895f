"""What the three functions should return, and the cases they are tried on."""


def endured(table, part):
    largest = 0.0
    for value, share in table:
        if share < part * table[0][1]:
            break
        largest = value
    return largest


def endured_cases(chance):
    yield {"table": [[0.0, 0.95], [0.1, 0.92], [0.2, 0.8], [0.3, 0.7]], "part": 0.8}
    yield {"table": [[0.0, 0.9], [0.1, 0.8], [0.2, 0.6], [0.3, 0.75]], "part": 0.8}
    yield {"table": [[0.0, 0.9], [0.1, 0.1]], "part": 0.8}
    yield {"table": [[0.0, 0.6], [0.1, 0.5], [0.2, 0.45]], "part": 0.8}
    for _ in range(25):
        shares = [round(chance.uniform(0.5, 1.0), 2)]
        for _ in range(chance.randint(2, 7)):
            shares.append(round(max(0.0, shares[-1] + chance.uniform(-0.2, 0.1)), 2))
        yield {
            "table": [[round(0.1 * k, 1), share] for k, share in enumerate(shares)],
            "part": chance.choice([0.5, 0.8, 0.9]),
        }


def delayed(commands, steps):
    return ([0.0] * steps + commands)[: len(commands)]


def delayed_cases(chance):
    yield {"commands": [0.4, 0.4, 0.1, 0.1], "steps": 2}
    yield {"commands": [0.4, 0.3], "steps": 0}
    yield {"commands": [0.4, 0.3], "steps": 5}
    for _ in range(15):
        count = chance.randint(1, 9)
        yield {
            "commands": [round(chance.uniform(-0.5, 0.5), 2) for _ in range(count)],
            "steps": chance.randint(0, 6),
        }


def carried_out(speed, rate, radius_error, drift):
    real = speed * (1 + radius_error)
    return [real, rate * (1 + radius_error) + drift * real]


def carried_out_cases(chance):
    yield {"speed": 0.3, "rate": 0.0, "radius_error": 0.0, "drift": 0.0}
    yield {"speed": 0.3, "rate": 0.0, "radius_error": 0.0, "drift": 1.0}
    yield {"speed": 0.0, "rate": 1.0, "radius_error": 0.1, "drift": 1.0}
    for _ in range(20):
        yield {
            "speed": round(chance.uniform(-0.5, 0.5), 2),
            "rate": round(chance.uniform(-1.5, 1.5), 2),
            "radius_error": round(chance.uniform(-0.3, 0.3), 2),
            "drift": round(chance.uniform(-2, 2), 2),
        }
