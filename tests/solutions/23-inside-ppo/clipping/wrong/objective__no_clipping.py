"""The objective of PPO for one step, and the entropy of a policy."""

# Lesson: from there on it is flat, and nothing pushes any more

import math


def objective(now, then, advantage, clip):
    """The smaller of ratio * advantage and (ratio within 1 - clip and 1 + clip) * advantage."""
    return now / then * advantage


def entropy(chances):
    """Minus the sum of chance * log(chance)."""
    return -sum(p * math.log(p) for p in chances if p > 0)
