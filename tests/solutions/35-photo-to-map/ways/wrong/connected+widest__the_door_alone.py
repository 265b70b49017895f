"""Whether a way leads from start to target, and for how wide a robot. A cell is [row, column]."""

# Lesson: Whether it gets from start to target


def fits(grid, cell, size):
    """Whether a robot can stand on a cell: all cells at most `size` rows and columns away are floor."""
    rows, columns = range(cell[0] - size, cell[0] + size + 1), range(cell[1] - size, cell[1] + size + 1)
    if rows[0] < 0 or columns[0] < 0 or rows[-1] >= len(grid) or columns[-1] >= len(grid[0]):
        return False
    return all(grid[row][column] != "#" for row in rows for column in columns)


def connected(grid, start, target, size):
    """Whether the door between the two rooms is as wide as the robot."""
    door = sum(row[len(row) // 2] != "#" for row in grid)
    return fits(grid, start, size) and fits(grid, target, size) and door >= 2 * size + 1


def widest(grid, start, target):
    """The largest size that gets there; -1 if not even size 0 does."""
    size = -1
    while connected(grid, start, target, size + 1):
        size += 1
    return size
