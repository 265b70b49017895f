"""What the three functions should return, and the cases they are tried on."""

WALL = 4


def examples(rows):
    return [[rows[k], rows[k + 1] - rows[k]] for k in range(len(rows) - 1)]


def imitate(known, row):
    return min(known, key=lambda example: abs(example[0] - row))[1]


def drive(known, row, winds):
    rows = [row]
    for wind in winds:
        row = row + imitate(known, row) + wind
        if abs(row) >= WALL:
            rows.append(WALL if row > 0 else -WALL)
            break
        rows.append(row)
    return rows


def examples_cases(chance):
    yield {"rows": [0, 0, 0]}
    yield {"rows": [2, 1, 0]}
    for _ in range(10):
        yield {"rows": random_rows(chance)}


def imitate_cases(chance):
    yield {"known": [[0, 0]], "row": 3}
    yield {"known": [[-1, 1], [1, -1]], "row": 0}
    yield {"known": [[1, -1], [-1, 1]], "row": 0}
    for _ in range(60):
        yield {"known": random_examples(chance, at_least=4), "row": chance.randint(-3, 3)}


def drive_cases(chance):
    yield {"known": [[0, 0]], "row": 0, "winds": [0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0]}
    yield {"known": [[0, 0], [1, -1], [-1, 1]], "row": 0, "winds": [0, 1, 0, 1, 0, -1, 0, 0]}
    yield {"known": [[0, 0]], "row": 3, "winds": [2, 0, 0]}
    for _ in range(20):
        winds = [chance.choice([-1, 0, 0, 0, 1]) for _ in range(12)]
        yield {"known": random_examples(chance), "row": chance.randint(-2, 2), "winds": winds}


def random_rows(chance):
    rows = [chance.randint(-3, 3)]
    while len(rows) < 8:
        rows.append(max(-3, min(3, rows[-1] + chance.choice([-1, 0, 1]))))
    return rows


def random_examples(chance, at_least=1):
    rows = chance.sample(range(-3, 4), chance.randint(at_least, at_least + 2))
    return [[row, chance.choice([-1, 0, 1])] for row in rows]
