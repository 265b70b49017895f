"""The image that turtles draw on, of 500 by 500 dots as turtlesim's window has, and the same as strokes for the world view."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.render.scene import PenStroke

Rgb = tuple[int, int, int]

METER: Final = 45
"""Dots a metre: the height of turtlesim's picture of a turtle."""
DOTS: Final = 500
SIDE_M: Final = (DOTS - 1) / METER
"""Length of the field's sides [m]: 11.0889."""
BACKGROUND: Final[Rgb] = (69, 86, 255)
MAX_POINTS: Final = 20_000
"""Points of strokes that are kept for the view; the oldest go first."""
SPACING_M: Final = 0.05
"""Distance of a stroke's points [m]."""


@dataclass(frozen=True, slots=True)
class Pen:
    """The pen that a turtle draws with."""

    color: Rgb = (179, 184, 255)
    width: int = 3
    """Width in dots."""
    is_down: bool = True


class Paper:
    """The field as the turtles have drawn on it; x to the right and y up [m], from the lower left corner."""

    def __init__(self) -> None:
        self._image = np.zeros((DOTS, DOTS, 3), dtype=np.uint8)
        self._strokes: list[tuple[str, Rgb, list[tuple[float, float]]]] = []
        self.clear(BACKGROUND)

    def clear(self, background: Rgb) -> None:
        """Removes all that was drawn."""
        self._image[:] = background
        self._strokes.clear()

    def draw_line(self, turtle: str, start: tuple[float, float], end: tuple[float, float], pen: Pen) -> None:
        """Draws a straight line of a turtle's pen."""
        if not pen.is_down:
            return
        (column, row), (last_column, last_row) = _dot(*start), _dot(*end)
        count = max(abs(last_column - column), abs(last_row - row)) + 1
        columns = np.linspace(column, last_column, count).round().astype(int)
        rows = np.linspace(row, last_row, count).round().astype(int)
        for across in range(-(pen.width // 2), (pen.width + 1) // 2):
            for down in range(-(pen.width // 2), (pen.width + 1) // 2):
                self._image[np.clip(rows + down, 0, DOTS - 1), np.clip(columns + across, 0, DOTS - 1)] = (
                    pen.color
                )
        self._add_to_stroke(turtle, start, end, pen.color)

    def color_at(self, x: float, y: float) -> Rgb:
        """The colour of the dot at a place [m]."""
        column, row = _dot(x, y)
        red, green, blue = self._image[row, column].tolist()
        return red, green, blue

    @property
    def strokes(self) -> tuple[PenStroke, ...]:
        """All lines, for the view."""
        return tuple(PenStroke(np.array(points), color) for _, color, points in self._strokes)

    def _add_to_stroke(
        self, turtle: str, start: tuple[float, float], end: tuple[float, float], color: Rgb
    ) -> None:
        last = next((each for each in reversed(self._strokes) if each[0] == turtle), None)
        if last is not None and last[1] == color and np.hypot(*np.subtract(start, last[2][-1])) < SPACING_M:
            if np.hypot(*np.subtract(end, last[2][-1])) >= SPACING_M:
                last[2].append(end)
        else:
            self._strokes.append((turtle, color, [start, end]))
        excess = sum(len(points) for _, _, points in self._strokes) - MAX_POINTS
        while excess > 0:
            oldest = self._strokes[0][2]
            if len(oldest) - excess < 2:  # no line is left of it
                del self._strokes[0]
                excess -= len(oldest)
            else:
                del oldest[:excess]
                excess = 0


def _dot(x: float, y: float) -> tuple[int, int]:
    """The column and row of a place's dot."""
    column, row = round(x * METER), round((SIDE_M - y) * METER)
    return min(max(column, 0), DOTS - 1), min(max(row, 0), DOTS - 1)
