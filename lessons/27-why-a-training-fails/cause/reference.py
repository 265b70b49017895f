"""What the two functions should return, and the cases they are tried on."""


def most(step, end, gamma, steps):
    found, earned = [], 0.0
    for number in range(steps):
        earned += gamma**number * step
        found.append(earned + gamma**number * end)
    return max(found)


def most_cases(chance):
    yield {"step": 10.0, "end": 400.0, "gamma": 0.99, "steps": 300}
    yield {"step": -1.0, "end": 100.0, "gamma": 0.9, "steps": 50}
    yield {"step": -1.0, "end": -5.0, "gamma": 1.0, "steps": 10}
    for _ in range(25):
        yield {
            "step": round(chance.uniform(-2, 10), 1),
            "end": round(chance.uniform(-300, 600), 0),
            "gamma": chance.choice((0.9, 0.99, 1.0)),
            "steps": chance.randint(1, 60),
        }


def fault(log, bound):
    last = log[-1]
    if any(test["value"] > bound for test in log):
        return "values"
    arrived = [test["return_reached"] for test in log if test["return_reached"] is not None]
    if last["timed_out"] > 0.5 and (not arrived or last["return_timed_out"] > max(arrived)):
        return "reward"
    if max(test["reached"] for test in log) - last["reached"] > 0.2:
        return "luck"
    return "none"


def fault_cases(chance):
    yield {"log": [row(900, 0.0, 1.0, None, 2700.0)], "bound": 1500.0}
    yield {"log": [row(2600, 0.1, 0.0, 900.0, None), row(900, 0.1, 0.0, 900.0, None)], "bound": 1500.0}
    yield {"log": [row(900, 0.7, 0.0, 1300.0, None), row(900, 0.2, 0.1, 1300.0, 200.0)], "bound": 1500.0}
    yield {"log": [row(900, 0.3, 0.0, 1300.0, None), row(950, 0.9, 0.0, 1300.0, None)], "bound": 1500.0}
    yield {"log": [row(900, 0.4, 0.0, 1300.0, None), row(950, 0.0, 0.9, None, 1000.0)], "bound": 1500.0}
    yield {"log": [row(900, 0.4, 0.0, 1300.0, None), row(950, 0.0, 0.9, None, 2700.0)], "bound": 1500.0}
    yield {"log": [row(900, 0.0, 1.0, None, 2700.0), row(950, 0.9, 0.0, 1300.0, None)], "bound": 1500.0}
    earned = (
        row(900, 0.3, 0.0, 900.0, None),
        row(900, 0.4, 0.0, 1300.0, None),
        row(900, 0.0, 0.9, None, 1100.0),
    )
    yield {"log": list(earned), "bound": 1500.0}
    for _ in range(30):
        yield {"log": [any_row(chance) for _ in range(chance.randint(1, 5))], "bound": 1500.0}


def row(value, reached, timed_out, return_reached, return_timed_out):
    return {
        "value": float(value),
        "reached": reached,
        "timed_out": timed_out,
        "return_reached": return_reached,
        "return_timed_out": return_timed_out,
    }


def any_row(chance):
    reached = chance.choice((0.0, 0.1, 0.3, 0.6, 0.9))
    timed_out = round(chance.choice((0.0, 0.3, 0.6, 1.0)) * (1 - reached), 2)
    return row(
        chance.choice((700, 900, 1400, 1450, 1490, 1495, 1499, 1600)),
        reached,
        timed_out,
        None if reached == 0 else round(chance.uniform(900, 1400), 0),
        None
        if timed_out == 0
        else round(chance.choice((chance.uniform(-300, 2800), chance.uniform(900, 1400))), 0),
    )
