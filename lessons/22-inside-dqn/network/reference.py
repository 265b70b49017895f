"""What the two functions should return, and the cases they are tried on."""


def value(inputs, weights):
    return sum(x * w for x, w in zip(inputs, weights, strict=True))


def value_cases(chance):
    yield {"inputs": [1.0, 2.0], "weights": [3.0, -1.0]}
    for _ in range(20):
        yield random_layer(chance)


def descend(inputs, weights, target, rate):
    error = value(inputs, weights) - target
    return [w - rate * 2 * error * x for x, w in zip(inputs, weights, strict=True)]


def descend_cases(chance):
    yield {"inputs": [1.0], "weights": [0.0], "target": 1.0, "rate": 0.1}
    yield {"inputs": [1.0, -2.0], "weights": [1.0, 1.0], "target": 0.5, "rate": 0.1}
    for _ in range(30):
        yield {
            **random_layer(chance),
            "target": round(chance.uniform(-3, 3), 2),
            "rate": chance.choice((0.01, 0.1, 0.5)),
        }


def random_layer(chance):
    count = chance.randint(2, 5)
    inputs, weights = ([round(chance.uniform(-2, 2), 2) for _ in range(count)] for _ in range(2))
    return {"inputs": inputs, "weights": weights}
