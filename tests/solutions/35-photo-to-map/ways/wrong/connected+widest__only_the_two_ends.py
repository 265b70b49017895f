"""Whether a way leads from start to target, and for how wide a robot. A cell is [row, column]."""

# Lesson: must fit everywhere on its way


def fits(grid, cell, size):
    """Whether a robot can stand on a cell: all cells at most `size` rows and columns away are floor."""
    for row in range(cell[0] - size, cell[0] + size + 1):
        for column in range(cell[1] - size, cell[1] + size + 1):
            if not (0 <= row < len(grid) and 0 <= column < len(grid[0])):
                return False
            if grid[row][column] == "#":
                return False
    return True


def connected(grid, start, target, size):
    """Whether it gets from start to target, by one cell up, down, left or right at a time."""
    return fits(grid, start, size) and fits(grid, target, size)


def widest(grid, start, target):
    """The largest size that gets there; -1 if not even size 0 does."""
    size = -1
    while connected(grid, start, target, size + 1):
        size += 1
    return size
