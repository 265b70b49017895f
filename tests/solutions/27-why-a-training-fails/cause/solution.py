"""What is at fault in a training that fails."""


def most(step, end, gamma, steps):
    """The largest discounted return of an episode of 1 to `steps` steps: `step` in each, and `end` added in the last.

    The reward after k steps counts gamma ** k, so the first one counts in full.
    """
    found, earned = [], 0.0
    for number in range(steps):
        earned += gamma**number * step
        found.append(earned + gamma**number * end)
    return max(found)


def fault(log, bound):
    """What is at fault; the first of these that holds."""
    last = log[-1]
    if any(test["value"] > bound for test in log):
        return "values"
    arrived = [test["return_reached"] for test in log if test["return_reached"] is not None]
    if last["timed_out"] > 0.5 and (not arrived or last["return_timed_out"] > max(arrived)):
        return "reward"
    if max(test["reached"] for test in log) - last["reached"] > 0.2:
        return "luck"
    return "none"
