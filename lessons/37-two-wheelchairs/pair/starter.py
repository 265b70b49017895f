"""One agent for two robots: its action, and its reward."""


def split(number, count):
    """The agent's number, and how many actions each robot has -> [the
    left one's action, the right one's].

    With four actions each: 0 is [0, 0], 1 is [0, 1], 3 is [0, 3], 4 is
    [1, 0], 15 is [3, 3].
    """
    return [0, 0]  # write this


def paid(before, after, beside, bumped):
    """The reward of a step.

    before, after: how far the left and the right robot have to go [m],
                   as [left, right]
    beside:        whether they are side by side
    bumped:        whether the left and the right one bumped, as
                   [left, right]
    """
    return 0.0  # write this
