"""A map of maybes: how likely it is that something stands in a cell."""

import math

HIT = 0.9  # added where a ray ended
FREE = -0.4  # added where a ray passed
LIMIT = 4.0  # log odds go no further, up or down


def updated(grid, free, hit):
    """A grid of log odds, as a list of rows -> a new one, after one ray.

    free: the cells that the ray passed, each as [row, column]
    hit:  the cell in which it ended, as [row, column]; None if it met
          nothing
    """
    return grid  # write this


def probability(log_odds):
    """Log odds -> the chance that something stands there, from 0 to 1."""
    return 0.0  # write this
