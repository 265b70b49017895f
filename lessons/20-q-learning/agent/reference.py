"""What the three functions should return, and the cases they are tried on."""


def update(table, cell, move, reward, next_cell, terminated, alpha, gamma):
    table = [list(row) for row in table]
    target = reward if terminated else reward + gamma * max(table[next_cell])
    table[cell][move] += alpha * (target - table[cell][move])
    return table


def update_cases(chance):
    yield {
        "table": [[0.0, 2.0], [10.0, 4.0]],
        "cell": 0,
        "move": 1,
        "reward": 1.0,
        "next_cell": 1,
        "terminated": False,
        "alpha": 0.5,
        "gamma": 0.9,
    }
    yield {
        "table": [[0.0, 0.4], [0.8, 0.2]],
        "cell": 0,
        "move": 1,
        "reward": -1.0,
        "next_cell": 1,
        "terminated": True,
        "alpha": 0.5,
        "gamma": 0.9,
    }
    for _ in range(30):
        table = random_table(chance)
        cell, move, reward, next_cell, terminated = random_step(chance, table)
        yield {
            "table": table,
            "cell": cell,
            "move": move,
            "reward": reward,
            "next_cell": next_cell,
            "terminated": terminated,
            "alpha": chance.choice((0.1, 0.5, 1.0)),
            "gamma": chance.choice((0.5, 0.9, 1.0)),
        }


def choose(values, epsilon, drawn, any_move):
    return any_move if drawn < epsilon else values.index(max(values))


def choose_cases(chance):
    yield {"values": [0.0, 0.5, 0.2, 0.5], "epsilon": 0.1, "drawn": 0.7, "any_move": 3}
    yield {"values": [0.0, 0.5, 0.2, 0.5], "epsilon": 0.1, "drawn": 0.05, "any_move": 3}
    yield {"values": [-1.0, -0.5, -2.0, -3.0], "epsilon": 0.0, "drawn": 0.0, "any_move": 0}
    for _ in range(60):
        values = [round(chance.uniform(-2, 2), 2) for _ in range(6)]
        epsilon, drawn = chance.choice((0.0, 0.1, 0.5, 1.0)), round(chance.random(), 2)
        yield {"values": values, "epsilon": epsilon, "drawn": drawn, "any_move": chance.randrange(6)}


def learn(table, steps, alpha, gamma):
    for cell, move, reward, next_cell, terminated in steps:
        table = update(table, cell, move, reward, next_cell, terminated, alpha, gamma)
    return table


def learn_cases(chance):
    corridor = [[0, 0, 0.0, 1, False], [1, 0, 0.0, 2, False], [2, 0, 1.0, 3, True]]
    yield {"table": [[0.0], [0.0], [0.0], [0.0]], "steps": corridor * 2, "alpha": 0.5, "gamma": 0.9}
    for _ in range(20):
        table = random_table(chance)
        steps = [random_step(chance, table) for _ in range(12)]
        yield {"table": table, "steps": steps, "alpha": 0.5, "gamma": 0.9}


def random_table(chance):
    return [[round(chance.uniform(-5, 5), 2) for _ in range(4)] for _ in range(5)]


def random_step(chance, table):
    cell, next_cell = chance.randrange(len(table)), chance.randrange(len(table))
    return [cell, chance.randrange(4), chance.choice((-1.0, 0.0, 1.0)), next_cell, chance.random() < 0.3]
