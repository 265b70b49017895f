"""A cross table: table[test][training] is the share of tests that
arrive."""


def worst(table):
    """The worst share of each training, a list."""
    return []  # write this


def choose(table):
    """The number of the training with the best worst case, the first of
    several that are equal."""
    return -1  # write this


def gap(table, column, trained_rows):
    """How much worse a training does where it was not trained.

    `column` is its number, `trained_rows` are the numbers of the tests
    that it was trained on. There are others too.
    """
    return 0.0  # write this
