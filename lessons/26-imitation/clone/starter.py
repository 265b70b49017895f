"""Behaviour cloning in a corridor with rows -3 to 3; rows -4 and 4 are
the walls."""

WALL = 4


def examples(rows):
    """[row, action] for each row of a recorded drive but the last."""
    return []  # write this


def imitate(known, row):
    """The action of the example whose row is nearest, the first of
    several that are equally near.

    known: a list of examples, each [row, action].
    """
    return None  # write this


def drive(known, row, winds):
    """The rows that a copy comes to from a row, that one included; the
    wall is the last one.

    winds: for each step, by how many rows the wind moves it, besides its
    action. What leads beyond a wall ends there.
    """
    return []  # write this
