"""What the three functions should return, and the cases they are tried on."""

import math


def chances(values, temperature):
    best = max(values)
    powers = [math.exp((value - best) / temperature) for value in values]
    return [power / sum(powers) for power in powers]


def chances_cases(chance):
    yield {"values": [2000.0, 2010.0], "temperature": 10.0}
    yield {"values": [0.0, 0.0, 0.0, 0.0], "temperature": 1.0}
    yield {"values": [-2000.0, -2005.0, -2001.0], "temperature": 5.0}
    for size in (1.0, 30.0, 3000.0, 50_000_000.0):
        for _ in range(6):
            base = round(chance.uniform(-size, size), 1)
            yield {"values": near(chance, base), "temperature": chance.choice((1.0, 5.0, 10.0))}


def limited(values, temperature, limit):
    return chances([min(value, limit) for value in values], temperature)


def limited_cases(chance):
    yield {"values": [700.0, 900.0, 480.0], "temperature": 10.0, "limit": 500.0}
    yield {"values": [-900.0, -905.0, -910.0], "temperature": 5.0, "limit": 500.0}
    for base in (470.0, 495.0, 505.0, 3000.0, -600.0):
        for _ in range(5):
            yield {"values": near(chance, base), "temperature": chance.choice((5.0, 10.0)), "limit": 500.0}


def blind(rows, limit):
    return sum(sorted(row)[-2] >= limit for row in rows) / len(rows)


def blind_cases(chance):
    yield {"rows": [[700.0, 480.0, 3.0], [700.0, 900.0, 3.0]], "limit": 500.0}
    yield {"rows": [[500.0, 500.0]], "limit": 500.0}
    for _ in range(20):
        rows = [near(chance, chance.choice((450.0, 495.0, 520.0))) for _ in range(chance.randint(1, 6))]
        yield {"rows": rows, "limit": 500.0}


def near(chance, base):
    """Values within some tens of one another."""
    return [round(base + chance.uniform(-20, 20), 1) for _ in range(chance.randint(2, 6))]
