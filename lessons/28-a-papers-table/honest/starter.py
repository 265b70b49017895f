"""A row of a table that others can trust, and what two rows prove."""

import math
import statistics

# Student's t for an interval of 95 %, by the number of seeds.
T = {2: 12.706, 3: 4.303, 4: 3.182, 5: 2.776, 6: 2.571, 7: 2.447, 8: 2.365, 9: 2.306, 10: 2.262}


def row(shares):
    """[mean, low, high] of the exams of 2 to 10 seeds.

    low and high are the mean minus and plus t * s / sqrt(n), with s the
    standard deviation of a sample; but no share is below 0 or above 1.
    """
    return [0.0, 0.0, 1.0]  # write this


def claim(one, other):
    """"better", "worse" or "open": what two rows [mean, low, high] prove
    of `one`."""
    # mend this: means alone prove nothing
    return "better" if one[0] > other[0] else "worse"


def differs(one, other):
    """The names of the conditions, sorted, in which two rows differ:
    dictionaries such as {"steps": 60000, "seeds": 5}."""
    return []  # write this


def beside(episodes):
    """The mean share of steps side by side, over the episodes that
    arrived; None if none did.

    Each episode is [whether it arrived, share of its steps side by
    side].
    """
    # mend this
    return sum(share for arrived, share in episodes) / len(episodes)
