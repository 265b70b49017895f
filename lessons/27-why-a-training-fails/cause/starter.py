"""What is at fault in a training that fails."""


def most(step, end, gamma, steps):
    """The largest discounted return of an episode of 1 to `steps` steps:
    `step` in each, and `end` added in the last.

    The reward after k steps counts gamma ** k, so the first one counts
    in full.
    """
    return step + end  # write this: it may last longer


def fault(log, bound):
    """What is at fault; the first of these that holds:

    "values"  in any test the largest value is above `bound`
    "reward"  in the last test more than half run out of time, and their
              mean return is above that of those that arrive: the largest
              `return_reached` of all tests, or none ever arrived
    "luck"    the best `reached` of all tests is more than 0.2 above that
              of the last one
    "none"    nothing of these

    `log` is a list of tests, each {"value", "reached", "timed_out",
    "return_reached", "return_timed_out"}.
    """
    return "none"  # write this
