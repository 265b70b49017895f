"""A map that is sketched square by square."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, Literal, Self

from kit.mapmaking.map_drawing import CELL, MAX_SIDE

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
        """Returns the square of the start or the target; None if it has not been set."""
        return next(((row.index(mark), number) for number, row in enumerate(self.rows) if mark in row), None)

    def square_at(self, x: float, y: float) -> Square:
        """The square of a point [m] from the lower left corner.

        >>> MapSketch.room(5, 4, 0.5).square_at(0.75, 1.75)
        (1, 0)
        """
        return int(x / self.cell), len(self.rows) - 1 - int(y / self.cell)

    def is_inside(self, square: Square) -> bool:
        return 0 <= square[0] < self.columns and 0 <= square[1] < len(self.rows)

    def drawn(self, mark: SketchMark, square: Square) -> Self:
        """Returns the sketch with a mark in a square; it moves a start or target. Outside the sheet nothing changes."""
        if not self.is_inside(square):
            return self
        rows = list(self.rows)
        if mark in "ST":
            rows = [row.replace(mark, " ") for row in rows]
        column, number = square
        rows[number] = rows[number][:column] + mark + rows[number][column + 1 :]
        return replace(self, rows=tuple(rows))

    def drawn_line(self, mark: SketchMark, first: Square, last: Square) -> Self:
        """Returns the sketch with a mark in every square from one square to another (Bresenham 1965)."""
        sketch = self
        for square in squares_between(first, last):
            sketch = sketch.drawn(mark, square)
        return sketch

    def scaled(self, steps: int) -> Self:
        """Returns the sketch with squares this many places further in ``SCALES``."""
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
