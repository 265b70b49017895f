"""How much of a best test is luck, and what may be reported."""

import math


def best_of(share, episodes, tests):
    """The best share of `tests` tests, on average, of an agent that
    arrives in `share` of all episodes.

    The chance of exactly k arrivals in a test is
    math.comb(episodes, k) * share**k * (1 - share)**(episodes - k).
    Let F(k) be the chance of at most k. The chance that no test has more
    than k arrivals is F(k) ** tests, so the chance that the best has
    exactly k is F(k) ** tests - F(k - 1) ** tests.
    """
    return share  # write this: that is right for one test alone


def report(tests, exams):
    """[place of the best test, from 0; share of its exam; how much more
    its test had promised].

    Each test and each exam is [arrived, episodes]; the newest of equal
    tests counts.
    """
    return [0, 0.0, 0.0]  # write this
