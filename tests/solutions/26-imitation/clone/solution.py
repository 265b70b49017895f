"""Behaviour cloning in a corridor with rows -3 to 3; rows -4 and 4 are the walls."""

WALL = 4


def examples(rows):
    """[row, action] for each row of a recorded drive but the last."""
    return [[rows[k], rows[k + 1] - rows[k]] for k in range(len(rows) - 1)]


def imitate(known, row):
    """The action of the example whose row is nearest, the first of several that are equally near."""
    return min(known, key=lambda example: abs(example[0] - row))[1]


def drive(known, row, winds):
    """The rows that a copy comes to from a row, that one included; the wall is the last one."""
    rows = [row]
    for wind in winds:
        row = row + imitate(known, row) + wind
        if abs(row) >= WALL:
            rows.append(WALL if row > 0 else -WALL)
            break
        rows.append(row)
    return rows
