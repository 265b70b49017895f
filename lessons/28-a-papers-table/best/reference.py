"""What the two functions should return, and the cases they are tried on."""

import math


def best_of(share, episodes, tests):
    found = below = at_most = 0.0
    for k in range(episodes + 1):
        binomial = math.comb(episodes, k) * share**k * (1 - share) ** (episodes - k)
        below, at_most = at_most, min(1.0, at_most + binomial)
        found += k / episodes * (at_most**tests - below**tests)
    return found


def best_of_cases(chance):
    yield {"share": 0.5, "episodes": 100, "tests": 60}
    yield {"share": 0.5, "episodes": 2, "tests": 2}
    for _ in range(20):
        yield {
            "share": round(chance.uniform(0, 1), 2),
            "episodes": chance.choice((4, 20, 100)),
            "tests": chance.choice((1, 2, 10, 60, 100)),
        }


def report(tests, exams):
    shares = [arrived / episodes for arrived, episodes in tests]
    place = max(range(len(tests)), key=lambda at: (shares[at], at))
    examined = exams[place][0] / exams[place][1]
    return [place, examined, shares[place] - examined]


def report_cases(chance):
    yield {"tests": [[60, 100], [77, 100], [50, 100]], "exams": [[55, 100], [64, 100], [80, 100]]}
    yield {"tests": [[4, 4], [90, 100]], "exams": [[60, 100], [88, 100]]}
    yield {"tests": [[8, 10], [80, 100]], "exams": [[60, 100], [79, 100]]}
    for _ in range(20):
        count = chance.randint(1, 6)
        yield {
            "tests": [any_test(chance) for _ in range(count)],
            "exams": [any_test(chance) for _ in range(count)],
        }


def any_test(chance):
    episodes = chance.choice((4, 10, 20, 100))
    return [chance.randint(0, 10) * episodes // 10, episodes]
