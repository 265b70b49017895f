"""What the four functions should return, and the cases they are tried on."""

import math
import statistics

T = {2: 12.706, 3: 4.303, 4: 3.182, 5: 2.776, 6: 2.571, 7: 2.447, 8: 2.365, 9: 2.306, 10: 2.262}


def row(shares):
    mean = statistics.fmean(shares)
    half = T[len(shares)] * statistics.stdev(shares) / math.sqrt(len(shares))
    return [mean, max(0.0, mean - half), min(1.0, mean + half)]


def row_cases(chance):
    yield {"shares": [0.65, 0.72, 0.76, 0.86, 0.94]}
    yield {"shares": [0.0, 0.0, 0.77]}
    yield {"shares": [1.0, 1.0]}
    for _ in range(20):
        middle = chance.uniform(0, 1)
        yield {"shares": [some_share(chance, middle) for _ in range(chance.randint(2, 10))]}


def claim(one, other):
    if one[1] > other[2]:
        return "better"
    return "worse" if one[2] < other[1] else "open"


def claim_cases(chance):
    yield {"one": [0.79, 0.64, 0.93], "other": [0.93, 0.87, 0.99]}
    yield {"one": [1.0, 1.0, 1.0], "other": [0.93, 0.87, 0.99]}
    yield {"one": [0.5, 0.4, 0.6], "other": [0.8, 0.61, 0.9]}
    for number in range(60):
        # Their ends are near each other, and what is between them decides.
        b = chance.randint(20, 75)
        a, c, d = b - chance.randint(6, 20), b + chance.randint(1, 4), b + chance.randint(10, 25)
        apart, across, within = ((a, b), (c, d)), ((a, c), (b, d)), ((a, d), (b, c))
        first, last = within if number % 15 == 0 else apart if number % 2 else across
        one, other = chance.sample((row_between(*first), row_between(*last)), 2)
        yield {"one": one, "other": other}


def differs(one, other):
    names = {*one, *other}
    return sorted(name for name in names if name not in one or name not in other or one[name] != other[name])


def differs_cases(chance):
    yield {"one": {"steps": 60000, "seeds": 5}, "other": {"steps": 60000, "seeds": 1}}
    yield {"one": {"steps": 60000, "chosen": "best test"}, "other": {"steps": 60000}}
    yield {"one": {"seeds": 0}, "other": {}}
    for _ in range(20):
        yield {"one": some_conditions(chance), "other": some_conditions(chance)}


def beside(episodes):
    shares = [share for arrived, share in episodes if arrived]
    return statistics.fmean(shares) if shares else None


def beside_cases(chance):
    yield {"episodes": [[False, 0.97], [False, 0.96]]}
    yield {"episodes": [[True, 0.3], [False, 0.97], [True, 0.5]]}
    yield {"episodes": [[True, 0.0]]}
    for _ in range(20):
        yield {
            "episodes": [
                [chance.random() < 0.5, round(chance.uniform(0, 1), 2)] for _ in range(chance.randint(1, 6))
            ]
        }


def some_share(chance, middle):
    return round(min(1.0, max(0.0, chance.gauss(middle, 0.15))), 2)


def row_between(low, high):
    """A row of the table, from its interval in percent."""
    return [(low + high) / 200, low / 100, high / 100]


def some_conditions(chance):
    names = ("steps", "seeds", "episodes", "reward")
    return {name: chance.choice((1, 5)) for name in names if chance.random() < 0.8}
