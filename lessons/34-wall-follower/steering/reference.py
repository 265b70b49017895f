"""What the two functions should return, and the cases they are tried on."""

import math

SIDES = ("right", "left")


def distance(ranges, side):
    rays = ranges[8:37] if side == "right" else ranges[54:83]
    return min((each for each in rays if math.isfinite(each)), default=10.0)


def distance_cases(chance):
    for side in SIDES:
        yield {"ranges": [math.nan] * 91, "side": side}
        yield {"ranges": [math.inf] * 91, "side": side}
        yield {"ranges": [round(0.3 + 0.02 * ray, 3) for ray in range(91)], "side": side}
        yield {"ranges": [round(2.1 - 0.02 * ray, 3) for ray in range(91)], "side": side}
        for _ in range(10):
            ranges = [round(chance.uniform(0.3, 3.0), 3) for _ in range(91)]
            for ray in chance.sample(range(91), 40):
                ranges[ray] = chance.choice([math.nan, math.inf])
            ranges[chance.choice([8, 54])] = ranges[chance.choice([36, 82])] = math.nan
            yield {"ranges": ranges, "side": side}


def rate(error, error_before, side):
    change = 0.0 if error_before is None else (error - error_before) / 0.1
    turn = max(-1.2, min(1.2, 4.0 * error + 4.0 * change))
    return turn if side == "right" else -turn


def rate_cases(chance):
    for side in SIDES:
        yield {"error": -0.2, "error_before": None, "side": side}
        yield {"error": 0.1, "error_before": 0.1, "side": side}
        yield {"error": -0.4, "error_before": -0.37, "side": side}
        yield {"error": -2.0, "error_before": 0.0, "side": side}
        for _ in range(15):
            error = round(chance.uniform(-0.3, 0.3), 3)
            yield {
                "error": error,
                "error_before": round(error + chance.uniform(-0.03, 0.03), 3),
                "side": side,
            }
