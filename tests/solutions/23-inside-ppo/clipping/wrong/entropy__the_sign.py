"""The objective of PPO for one step, and the entropy of a policy."""

# Lesson: minus the sum of chance * log(chance)

import math


def objective(now, then, advantage, clip):
    """The smaller of ratio * advantage and (ratio within 1 - clip and 1 + clip) * advantage."""
    ratio = now / then
    near = max(1 - clip, min(1 + clip, ratio))
    return min(ratio * advantage, near * advantage)


def entropy(chances):
    """Minus the sum of chance * log(chance)."""
    return sum(p * math.log(p) for p in chances if p > 0)
