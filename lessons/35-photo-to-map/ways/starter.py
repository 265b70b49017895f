"""Whether a way leads from start to target, and for how wide a robot. A
cell is [row, column]."""


def fits(grid, cell, size):
    """Whether a robot can stand on a cell: all cells at most `size` rows
    and columns away are floor."""
    return None  # write this


def connected(grid, start, target, size):
    """Whether it gets from start to target, by one cell up, down, left
    or right at a time."""
    return None  # write this


def widest(grid, start, target):
    """The largest size that gets there; -1 if not even size 0 does."""
    return None  # write this
