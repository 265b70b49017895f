"""What the three functions should return, and the cases they are tried on."""

WALL = 4
TEACHER = [1, 1, 1, 0, -1, -1, -1]


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


def asked(rows, teacher):
    return [[row, teacher[row + 3]] for row in rows if abs(row) < WALL]


def dagger(known, row, winds, teacher, rounds):
    known = list(known)
    for _ in range(rounds):
        visited = drive(known, row, winds)
        known = known + asked(visited, teacher)
    return known


def agreement(known, rows, teacher):
    inside = [row for row in rows if abs(row) < WALL]
    return sum(imitate(known, row) == teacher[row + 3] for row in inside) / len(inside)


def asked_cases(chance):
    yield {"rows": [0, 1, 2, 3, 4], "teacher": TEACHER}
    yield {"rows": [0, -1, -3, -4], "teacher": TEACHER}
    for _ in range(10):
        yield {"rows": [chance.randint(-3, 3) for _ in range(6)], "teacher": random_teacher(chance)}


def dagger_cases(chance):
    gusts = [0, 1, 0, 0, 0] * 4
    for rounds in (0, 1, 2, 3):
        yield {"known": [[0, 0]], "row": 0, "winds": gusts, "teacher": TEACHER, "rounds": rounds}
    for _ in range(20):
        winds = [chance.choice([-1, 0, 0, 1]) for _ in range(10)]
        known = [[0, chance.choice([-1, 0, 1])], [chance.choice([-2, 2]), chance.choice([-1, 0, 1])]]
        yield {
            "known": known,
            "row": 0,
            "winds": winds,
            "teacher": random_teacher(chance),
            "rounds": chance.randint(1, 3),
        }


def agreement_cases(chance):
    yield {"known": [[0, 0]], "rows": [0, 0, 0, 0], "teacher": TEACHER}
    yield {"known": [[0, 0]], "rows": [0, 1, 2, 3, 4], "teacher": TEACHER}
    for _ in range(15):
        known = [[row, chance.choice([-1, 0, 1])] for row in chance.sample(range(-3, 4), 3)]
        rows = [chance.randint(-3, 3) for _ in range(7)] + chance.choice([[], [4], [-4]])
        yield {"known": known, "rows": rows, "teacher": random_teacher(chance)}


def random_teacher(chance):
    return [chance.choice([-1, 0, 1]) for _ in range(7)]
