"""Whether a way leads from start to target, and for how wide a robot. A cell is [row, column]."""

# Lesson: covers all cells at most n rows and n columns away


def fits(grid, cell, size):
    """Whether a robot can stand on a cell: all cells at most `size` rows and columns away are floor."""
    for row in range(cell[0] - size, cell[0] + size):
        for column in range(cell[1] - size, cell[1] + size):
            if not (0 <= row < len(grid) and 0 <= column < len(grid[0])):
                return False
            if grid[row][column] == "#":
                return False
    return True


def connected(grid, start, target, size):
    """Whether it gets from start to target, by one cell up, down, left or right at a time."""
    if not fits(grid, start, size):
        return False
    been = [list(start)]
    for row, column in been:  # the list grows while it is gone through
        for other in ([row - 1, column], [row + 1, column], [row, column - 1], [row, column + 1]):
            if other not in been and fits(grid, other, size):
                been.append(other)
    return list(target) in been


def widest(grid, start, target):
    """The largest size that gets there; -1 if not even size 0 does."""
    size = -1
    while size < 20 and connected(grid, start, target, size + 1):
        size += 1
    return size
