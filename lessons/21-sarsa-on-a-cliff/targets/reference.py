"""What the three functions should return, and the cases they are tried on."""


def q_target(reward, next_values, terminated, gamma):
    return reward if terminated else reward + gamma * max(next_values)


def q_target_cases(chance):
    yield {"reward": -1.0, "next_values": [-6.0, -8.0, -7.0, -100.0], "terminated": False, "gamma": 1.0}
    for _ in range(30):
        yield random_case(chance)


def sarsa_target(reward, next_values, next_move, terminated, gamma):
    return reward if terminated else reward + gamma * next_values[next_move]


def sarsa_target_cases(chance):
    yield {
        "reward": -1.0,
        "next_values": [-6.0, -8.0, -7.0, -100.0],
        "next_move": 3,
        "terminated": False,
        "gamma": 1.0,
    }
    for _ in range(30):
        yield {**random_case(chance), "next_move": chance.randrange(4)}


def expected_target(reward, next_values, epsilon, terminated, gamma):
    mean = sum(next_values) / len(next_values)
    future = epsilon * mean + (1 - epsilon) * max(next_values)
    return reward if terminated else reward + gamma * future


def expected_target_cases(chance):
    yield {
        "reward": -1.0,
        "next_values": [-6.0, -8.0, -7.0, -100.0],
        "epsilon": 0.1,
        "terminated": False,
        "gamma": 1.0,
    }
    for _ in range(30):
        yield {**random_case(chance), "epsilon": chance.choice((0.0, 0.1, 0.4, 1.0))}


def random_case(chance):
    return {
        "reward": chance.choice((-100.0, -1.0, 1.0)),
        "next_values": [round(chance.uniform(-20, 5), 2) for _ in range(4)],
        "terminated": chance.random() < 0.25,
        "gamma": chance.choice((0.5, 0.9, 1.0)),
    }
