"""A cross table: table[test][training] is the share of tests that arrive."""

# Lesson: The diagonal alone would say that all is well.


def worst(table):
    """The worst share of each training, a list."""
    return [min(row[k] for row in table) for k in range(len(table[0]))]


def choose(table):
    """The number of the training with the best worst case."""
    bests = [max(row[k] for row in table) for k in range(len(table[0]))]
    return bests.index(max(bests))


def gap(table, column, trained_rows):
    """How much worse a training does where it was not trained."""
    seen = [table[row][column] for row in trained_rows]
    rest = [table[row][column] for row in range(len(table)) if row not in trained_rows]
    return sum(seen) / len(seen) - sum(rest) / len(rest)
