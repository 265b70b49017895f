"""The objective of PPO for one step, and the entropy of a policy."""

import math


def objective(now, then, advantage, clip):
    """The smaller of ratio * advantage and (ratio within 1 - clip and 1
    + clip) * advantage.

    `now` and `then` are the chances of the move: by the policy as it is,
    and when the batch was collected.
    """
    return 0.0  # write this


def entropy(chances):
    """Minus the sum of chance * log(chance). A chance of 0 adds nothing.
    """
    return -1.0  # write this, with math.log
