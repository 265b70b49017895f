"""What the three functions should return, and the cases they are tried on."""


def worst(table):
    return [min(row[k] for row in table) for k in range(len(table[0]))]


def worst_cases(chance):
    yield {"table": [[0.96, 0.01, 0.99], [0.06, 1.0, 0.99]]}
    for _ in range(20):
        yield {"table": random_table(chance)}


def choose(table):
    worsts = worst(table)
    return worsts.index(max(worsts))


def choose_cases(chance):
    yield {"table": [[0.96, 0.01, 0.99], [0.06, 1.0, 0.99]]}
    yield {"table": [[1.0, 0.7], [0.5, 0.6]]}
    yield {"table": [[1.0, 0.6], [1.0, 0.6], [0.3, 0.6]]}
    yield {"table": [[0.5, 0.5], [0.9, 0.9]]}
    for _ in range(60):
        yield {"table": random_table(chance)}


def gap(table, column, trained_rows):
    seen = [table[row][column] for row in trained_rows]
    rest = [table[row][column] for row in range(len(table)) if row not in trained_rows]
    return sum(seen) / len(seen) - sum(rest) / len(rest)


def gap_cases(chance):
    yield {"table": [[0.96, 0.01], [0.06, 1.0]], "column": 0, "trained_rows": [0]}
    yield {"table": [[0.96, 0.01], [0.06, 1.0]], "column": 1, "trained_rows": [1]}
    for _ in range(20):
        table = random_table(chance)
        rows = sorted(chance.sample(range(len(table)), chance.randint(1, len(table) - 1)))
        yield {"table": table, "column": chance.randrange(len(table[0])), "trained_rows": rows}


def random_table(chance):
    columns = chance.randint(3, 6)
    return [[round(chance.random(), 2) for _ in range(columns)] for _ in range(chance.randint(3, 5))]
