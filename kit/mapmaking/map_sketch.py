"""A map while it is drawn, square by square: walls, start, target and scale. Every change makes a new sketch.

Reads a map drawn in characters: ``#`` is a wall, a blank or a full stop is floor, S the start, T the target.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal, Self

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
        raise DrawingError(
            f"{name} is empty. Draw walls with #, and S and T where the robot starts and where it must go."
        )
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
                    f"{place}: {quoted(letter)} is none of # (wall), blank (floor), S (start) and T (target)."
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


Square = tuple[int, int]
"""Column and row, from the upper left corner."""
SketchMark = Literal["#", " ", "S", "T"]
"""Wall, floor, start, target, as in a drawing in characters."""

MIN_SIDE: Final = 4
SCALES: Final = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0)
"""Sides of a square to choose from [m]."""


@dataclass(frozen=True, slots=True)
class MapSketch:
    """Rows of ``#``, blanks, at most one S and one T, as ``read_drawing`` reads them."""

    rows: tuple[str, ...]
    """All equally long."""
    cell: float = CELL
    """Side of a square [m]."""

    @classmethod
    def room(cls, columns: int, rows: int, cell: float = CELL) -> Self:
        """An empty room with walls around it. ValueError for a size that is too small or too large.

        >>> print(MapSketch.room(5, 4).text)
        #####
        #   #
        #   #
        #####
        <BLANKLINE>
        """
        if not (MIN_SIDE <= columns <= MAX_SIDE and MIN_SIDE <= rows <= MAX_SIDE):
            raise ValueError(f"{columns} x {rows} squares; each side takes {MIN_SIDE} to {MAX_SIDE}")
        inner = "#" + " " * (columns - 2) + "#"
        return cls(("#" * columns, *([inner] * (rows - 2)), "#" * columns), cell)

    @property
    def columns(self) -> int:
        return len(self.rows[0])

    @property
    def text(self) -> str:
        """The drawing in characters."""
        return "\n".join(self.rows) + "\n"

    @property
    def size(self) -> tuple[float, float]:
        """Width and height [m]."""
        return self.columns * self.cell, len(self.rows) * self.cell

    def find(self, mark: SketchMark) -> Square | None:
        """Where the start or the target is; None if it has not been set."""
        return next(((row.index(mark), number) for number, row in enumerate(self.rows) if mark in row), None)

    def is_inside(self, square: Square) -> bool:
        return 0 <= square[0] < self.columns and 0 <= square[1] < len(self.rows)

    def drawn(self, mark: SketchMark, square: Square) -> Self:
        """With a mark in a square; a start or target that stood elsewhere moves there. The same outside the sheet."""
        if not self.is_inside(square):
            return self
        rows = list(self.rows)
        if mark in "ST":
            rows = [row.replace(mark, " ") for row in rows]
        column, number = square
        rows[number] = rows[number][:column] + mark + rows[number][column + 1 :]
        return replace(self, rows=tuple(rows))

    def drawn_line(self, mark: SketchMark, first: Square, last: Square) -> Self:
        """With a mark in every square between two squares, both included (Bresenham 1965)."""
        sketch = self
        for square in squares_between(first, last):
            sketch = sketch.drawn(mark, square)
        return sketch

    def scaled(self, steps: int) -> Self:
        """With the side of its squares this many places further in ``SCALES``."""
        nearest = min(range(len(SCALES)), key=lambda place: abs(SCALES[place] - self.cell))
        return replace(self, cell=SCALES[max(0, min(nearest + steps, len(SCALES) - 1))])


def squares_between(first: Square, last: Square) -> list[Square]:
    """The squares on the straight line between two, both included."""
    (x, y), (x2, y2) = first, last
    dx, dy = abs(x2 - x), -abs(y2 - y)
    step_x, step_y = (1 if x2 > x else -1), (1 if y2 > y else -1)
    error, squares = dx + dy, [first]
    while (x, y) != last:
        twice = 2 * error
        if twice >= dy:
            error += dy
            x += step_x
        if twice <= dx:
            error += dx
            y += step_y
        squares.append((x, y))
    return squares
