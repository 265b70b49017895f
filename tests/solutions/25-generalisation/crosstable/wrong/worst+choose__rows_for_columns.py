"""A cross table: table[test][training] is the share of tests that arrive."""

# Lesson: a column for each training, a row for each test


def worst(table):
    """The worst share of each training, a list."""
    return [min(row) for row in table]


def choose(table):
    """The number of the training with the best worst case."""
    worsts = worst(table)
    return worsts.index(max(worsts))


def gap(table, column, trained_rows):
    """How much worse a training does where it was not trained."""
    seen = [table[row][column] for row in trained_rows]
    rest = [table[row][column] for row in range(len(table)) if row not in trained_rows]
    return sum(seen) / len(seen) - sum(rest) / len(rest)
