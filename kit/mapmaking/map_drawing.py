"""A map drawn in characters, read into a plan of walls."""

from __future__ import annotations

from typing import Final

import numpy as np

from kit.mapmaking.new_map import FINEST, WallPlan
from kit.plain_text import quoted

WALL: Final = "#"
FLOOR: Final = " ."

MAX_SIDE: Final = 400
"""Characters of a row, and rows."""

CELL: Final = 0.5
"""Side of a character's square [m], unless another is asked for."""


class DrawingError(ValueError):
    """A drawing that is no map; the message names line and column."""


def read_drawing(text: str, *, cell: float = CELL, name: str = "the drawing") -> WallPlan:
    """The walls of a drawing; each character is a square of ``cell`` metres. Raises DrawingError.

    >>> plan = read_drawing("#####\\n#S T#\\n#####", cell=0.5)
    >>> plan.size, plan.start, plan.target
    ((2.5, 1.5), (0.75, 0.75), (1.75, 0.75))
    """
    rows = [line.rstrip("\n\r") for line in text.expandtabs(4).splitlines()]
    while rows and not rows[-1].strip():
        rows.pop()
    while rows and not rows[0].strip():
        rows.pop(0)
    if not rows:
        raise DrawingError(f"{name} is empty. Draw walls with #, the start with S and the target with T.")
    columns = max(map(len, rows))
    if max(len(rows), columns) > MAX_SIDE:
        raise DrawingError(
            f"{name} has {len(rows)} rows of up to {columns} characters; at most {MAX_SIDE} are read."
        )
    marks: dict[str, tuple[int, int]] = {}
    walls = np.zeros((len(rows), columns), dtype=np.bool_)
    for number, row in enumerate(rows):
        for column, letter in enumerate(row):
            place = f"{name}, line {number + 1}, column {column + 1}"
            if letter == WALL:
                walls[number, column] = True
            elif letter in "ST":
                if letter in marks:
                    raise DrawingError(f"{place}: a second {letter}; a map has one start and one target.")
                marks[letter] = (number, column)
            elif letter not in FLOOR:
                raise DrawingError(
                    f"{place}: {quoted(letter)} is not one of # (wall), space (floor), S (start) and T (target)."
                )
    if not walls.any():
        raise DrawingError(f"{name} has no wall. Draw walls with #.")
    fine = max(1, min(8, int(cell / FINEST), 2000 // max(len(rows), columns)))
    points = {
        letter: ((column + 0.5) * cell, (len(rows) - number - 0.5) * cell)
        for letter, (number, column) in marks.items()
    }
    return WallPlan(
        np.kron(walls, np.ones((fine, fine), dtype=np.bool_)), cell / fine, points.get("S"), points.get("T")
    )
