"""How sure a test makes us, and which policy to keep."""

import math

Z = 1.645  # this many standard deviations: right in 95 of 100 cases


def at_least(reached, episodes):
    """The share that the truth is surely not below, when `reached` of
    `episodes` arrived (Wilson, 1927).

    With p = reached / episodes and n = episodes:

        p + Z*Z/(2n) - Z * sqrt(p(1-p)/n + Z*Z/(4n*n))
        ----------------------------------------------
                       1 + Z*Z/n
    """
    return reached / episodes  # write this


def keep(tests):
    """Which test's policy to keep: its place in the list, from 0. The
    newer one if two are equal.

    Each test is a list of cases, each case [reached, episodes]. A test
    is as good as what at_least() says of its worst case.
    """
    # write this: the newest is not always the best
    return len(tests) - 1
