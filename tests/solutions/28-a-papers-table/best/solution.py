"""How much of a best test is luck, and what may be reported."""

import math


def best_of(share, episodes, tests):
    """The best share of `tests` tests, on average, of an agent that arrives in `share` of all episodes."""
    found = below = at_most = 0.0
    for k in range(episodes + 1):
        binomial = math.comb(episodes, k) * share**k * (1 - share) ** (episodes - k)
        below, at_most = at_most, min(1.0, at_most + binomial)
        found += k / episodes * (at_most**tests - below**tests)
    return found


def report(tests, exams):
    """[place of the best test, from 0; share of its exam; how much more its test had promised]."""
    shares = [arrived / episodes for arrived, episodes in tests]
    place = max(range(len(tests)), key=lambda at: (shares[at], at))
    examined = exams[place][0] / exams[place][1]
    return [place, examined, shares[place] - examined]
