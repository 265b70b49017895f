"""A row of a table that others can trust, and what two rows prove."""

import math
import statistics

# Student's t for an interval of 95 %, by the number of seeds.
T = {2: 12.706, 3: 4.303, 4: 3.182, 5: 2.776, 6: 2.571, 7: 2.447, 8: 2.365, 9: 2.306, 10: 2.262}


def row(shares):
    """[mean, low, high] of the exams of 2 to 10 seeds."""
    mean = statistics.fmean(shares)
    half = T[len(shares)] * statistics.stdev(shares) / math.sqrt(len(shares))
    return [mean, max(0.0, mean - half), min(1.0, mean + half)]


def claim(one, other):
    """What two rows [mean, low, high] prove of `one`: better, worse or open."""
    if one[1] > other[2]:
        return "better"
    return "worse" if one[2] < other[1] else "open"


def differs(one, other):
    """The names of the conditions, sorted, in which two rows differ: dictionaries such as {"steps": 60000, "seeds": 5}."""
    names = {*one, *other}
    return sorted(name for name in names if name not in one or name not in other or one[name] != other[name])


def beside(episodes):
    """The mean share of steps side by side, over the episodes that arrived; None if none did."""
    shares = [share for arrived, share in episodes if arrived]
    return statistics.fmean(shares) if shares else None
