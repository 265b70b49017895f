"""Draw moves by their values: in proportion to exp(value / temperature)."""

import math


def chances(values, temperature):
    """The chance of each move; together they are 1. The values may be of any size, also in the thousands."""
    best = max(values)
    powers = [math.exp((value - best) / temperature) for value in values]
    return [power / sum(powers) for power in powers]


def limited(values, temperature, limit):
    """The same, but every value above `limit` is taken for `limit`."""
    return chances([min(value, limit) for value in values], temperature)


def blind(rows, limit):
    """The share of the rows whose two best values are both at the limit or above it. A row has at least two values."""
    return sum(sorted(row)[-2] >= limit for row in rows) / len(rows)
