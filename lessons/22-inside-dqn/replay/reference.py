"""What the three functions should return, and the cases they are tried on."""


def store(buffer, step, capacity):
    return [*buffer, step][-capacity:]


def store_cases(chance):
    yield {"buffer": [1, 2, 3], "step": 4, "capacity": 3}
    yield {"buffer": [1, 2], "step": 3, "capacity": 3}
    for _ in range(20):
        capacity = chance.randint(1, 6)
        size = chance.choice((capacity, capacity, chance.randint(0, capacity)))
        buffer = [chance.randint(0, 99) for _ in range(size)]
        yield {"buffer": buffer, "step": chance.randint(100, 199), "capacity": capacity}


def targets(batch, next_values, gamma):
    return [
        reward if terminated else reward + gamma * max(values)
        for (reward, terminated), values in zip(batch, next_values, strict=True)
    ]


def targets_cases(chance):
    yield {"batch": [[1.0, True], [0.0, False]], "next_values": [[5.0, 2.0], [1.0, 4.0]], "gamma": 0.9}
    for _ in range(20):
        count = chance.randint(1, 5)
        batch = [[chance.choice((-1.0, 0.0, 1.0)), chance.random() < 0.3] for _ in range(count)]
        values = [[round(chance.uniform(-4, 4), 2) for _ in range(3)] for _ in range(count)]
        yield {"batch": batch, "next_values": values, "gamma": chance.choice((0.5, 0.9))}


def synced(target, online, updates, interval):
    return online if updates % interval == 0 else target


def synced_cases(chance):
    yield {"target": [1.0], "online": [2.0], "updates": 100, "interval": 50}
    yield {"target": [1.0], "online": [2.0], "updates": 120, "interval": 50}
    for _ in range(30):
        interval = chance.choice((2, 10, 50))
        on_time = interval * chance.randint(1, 9)
        updates = chance.choice((on_time, on_time + 1, on_time + interval // 2, on_time - 1))
        weights = [[round(chance.uniform(-1, 1), 2) for _ in range(2)] for _ in range(2)]
        yield {"target": weights[0], "online": weights[1], "updates": updates, "interval": interval}
