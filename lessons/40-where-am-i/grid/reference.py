"""What the two functions should return, and the cases they are tried on."""

import math

HIT, FREE, LIMIT = 0.9, -0.4, 4.0


def updated(grid, free, hit):
    new = [list(row) for row in grid]
    for row, column in free:
        new[row][column] = max(-LIMIT, new[row][column] + FREE)
    if hit is not None:
        row, column = hit
        new[row][column] = min(LIMIT, new[row][column] + HIT)
    return new


def updated_cases(chance):
    nothing = [[0.0] * 4 for _ in range(3)]
    yield {"grid": nothing, "free": [[1, 0], [1, 1]], "hit": [1, 2]}
    yield {"grid": nothing, "free": [[1, 0], [1, 1], [1, 2], [1, 3]], "hit": None}
    yield {"grid": [[3.8, -3.8, 0.5]], "free": [[0, 1]], "hit": [0, 0]}
    for _ in range(30):
        rows, columns = chance.randint(2, 4), chance.randint(3, 6)
        row, end = chance.randrange(rows), chance.randrange(1, columns)
        yield {
            "grid": [[round(chance.uniform(-4, 4), 1) for _ in range(columns)] for _ in range(rows)],
            "free": [[row, column] for column in range(end)],
            "hit": chance.choice(([row, end], None)),
        }


def probability(log_odds):
    return 1 / (1 + math.exp(-log_odds))


def probability_cases(chance):
    for value in (0.0, 4.0, -4.0, 0.9, -0.4):
        yield {"log_odds": value}
    for _ in range(20):
        yield {"log_odds": chance.uniform(-4, 4)}
