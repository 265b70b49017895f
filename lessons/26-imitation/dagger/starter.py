"""DAgger in a corridor with rows -3 to 3; rows -4 and 4 are the walls."""

WALL = 4


def imitate(known, row):
    """The action of the example whose row is nearest, the first of
    several that are equally near."""
    return min(known, key=lambda example: abs(example[0] - row))[1]


def drive(known, row, winds):
    """The rows that a copy comes to from a row, that one included; the
    wall is the last one."""
    rows = [row]
    for wind in winds:
        row = row + imitate(known, row) + wind
        if abs(row) >= WALL:
            rows.append(WALL if row > 0 else -WALL)
            break
        rows.append(row)
    return rows


def asked(rows, teacher):
    """[row, the teacher's action] for each row visited, the walls left
    out.

    teacher: its actions in the rows -3, -2, -1, 0, 1, 2 and 3.
    """
    return []  # write this


def dagger(known, row, winds, teacher, rounds):
    """The examples after this many rounds: those known before, and all
    answers in their order."""
    return []  # write this


def agreement(known, rows, teacher):
    """The share of the rows visited, the walls left out, in which the
    copy does what the teacher would do."""
    return 0.0  # write this
