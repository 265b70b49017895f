"""A grid of characters on which lines, labels and boxes are drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import groupby
from typing import Final

from kit.layers.drawing.spans import STYLE_RANK, DrawingLine, DrawingSpan, DrawingStyle, GlyphStyle

_FRAMES: Final = {
    "body": ("─", "│", "┌┐└┘"),
    "laser": ("─", "│", "┌┐└┘"),
    "map": ("═", "║", "╔╗╚╝"),
    "group": ("━", "┃", "┏┓┗┛"),
}
"""Across, down and the four corners of a box."""


_ASCII_FRAMES: Final = {
    "body": ("-", "|", "++++"),
    "map": ("=", "|", "####"),
    "group": ("#", "#", "####"),
}


_BRAILLE: Final = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
"""The bit of each dot of a braille character, by row and column."""
DASH: Final = 4
"""Dots of a dash, and between two, of a line that is struck."""
BOX_ROWS: Final = 4


@dataclass(frozen=True, slots=True)
class EntityBox:
    """A name and what it is, in a box of four rows around ``middle`` (column, row)."""

    middle: tuple[float, float]
    label: str
    kind: str
    style: DrawingStyle
    has_cursor: bool = False
    """Whether the label stands out."""

    @property
    def width(self) -> int:
        return max(len(self.label), len(self.kind)) + 4

    @property
    def corner(self) -> tuple[int, int]:
        """Column and row of the character at the top left."""
        return round(self.middle[0] - (self.width - 1) / 2), round(self.middle[1] - (BOX_ROWS - 1) / 2)

    def touches(self, other: EntityBox) -> bool:
        """Whether fewer than two columns or one row lie between the boxes."""
        across, down = abs(self.corner[0] - other.corner[0]), abs(self.corner[1] - other.corner[1])
        widest = self.width if self.corner[0] <= other.corner[0] else other.width
        return across < widest + 2 and down < BOX_ROWS + 1


class TextCanvas:
    """A grid of characters with lines under labels. Columns and rows from 0, at the top left."""

    def __init__(self, width: int, height: int, glyphs: GlyphStyle) -> None:
        self._width, self._height, self._glyphs = width, height, glyphs
        self._dots: dict[tuple[int, int], int] = {}
        self._styles: dict[tuple[int, int], DrawingStyle] = {}
        self._letters: dict[tuple[int, int], str] = {}

    def line(self, start: tuple[float, float], end: tuple[float, float], style: DrawingStyle) -> None:
        """A straight line between two characters' middles."""
        draw = self._draw_braille_line if self._glyphs == "braille" else self._draw_ascii_line
        draw(start, end, style)

    def label(self, middle: tuple[float, float], text: str, style: DrawingStyle) -> None:
        """Text over whatever is there, moved so that it fits."""
        for cell, letter in zip(self._label_cells(middle, text), text, strict=False):
            self._letters[cell], self._styles[cell] = letter, style

    def is_free_of_words(self, middle: tuple[float, float], text: str) -> bool:
        """Whether a label would cover nothing but lines."""
        styles = (self._styles.get(cell, "space") for cell in self._label_cells(middle, text))
        return all(STYLE_RANK[style] < STYLE_RANK["layer"] for style in styles)

    def _label_cells(self, middle: tuple[float, float], text: str) -> list[tuple[int, int]]:
        row = min(max(round(middle[1]), 0), self._height - 1)
        width = min(len(text), self._width)
        first = min(max(round(middle[0] - (width - 1) / 2), 0), self._width - width)
        return [(first + i, row) for i in range(width)]

    def box(self, box: EntityBox) -> None:
        """A frame over whatever is there: thick around the group, double around a map."""
        is_ascii = self._glyphs == "ascii"
        across, down, corners = _FRAMES.get(box.style if box.style == "group" else box.kind, _FRAMES["body"])
        if is_ascii:
            across, down, corners = _ASCII_FRAMES.get(box.style, _ASCII_FRAMES["body"])
        inner = box.width - 2
        left, top = box.corner
        rows = (
            corners[0] + across * inner + corners[1],
            f"{down}{box.label:^{inner}}{down}",
            f"{down}{box.kind:^{inner}}{down}",
            corners[2] + across * inner + corners[3],
        )
        for number, text in enumerate(rows):
            for i, letter in enumerate(text):
                self._letters[left + i, top + number] = letter
                inside = 0 < i < box.width - 1
                style: DrawingStyle = (
                    "text" if number == 2 else "cursor" if number == 1 and box.has_cursor else box.style
                )
                self._styles[left + i, top + number] = style if inside else box.style

    def arrow(self, start: EntityBox, end: EntityBox) -> None:
        """The head of an arrow where a line from one box meets another's frame."""
        across, down = end.middle[0] - start.middle[0], end.middle[1] - start.middle[1]
        sides = (end.width / 2 + 0.6) / abs(across) if across else math.inf
        ends = (BOX_ROWS / 2 + 0.1) / abs(down) if down else math.inf
        share = 1 - min(sides, ends)
        signs = "<>^v" if self._glyphs == "ascii" else "←→↑↓"
        sign = signs[int(across > 0)] if sides < ends else signs[2 + int(down > 0)]
        cell = round(start.middle[0] + across * share), round(start.middle[1] + down * share)
        self._letters[cell], self._styles[cell] = sign, "beam"

    def lines(self) -> list[DrawingLine]:
        return [
            tuple(
                DrawingSpan("".join(glyph for glyph, _ in run), style)
                for style, run in groupby(
                    (self._cell(column, row) for column in range(self._width)), lambda c: c[1]
                )
            )
            for row in range(self._height)
        ]

    def _cell(self, column: int, row: int) -> tuple[str, DrawingStyle]:
        cell = column, row
        if cell in self._letters:
            return self._letters[cell], self._styles[cell]
        if cell in self._dots:
            return chr(0x2800 + self._dots[cell]), self._styles[cell]
        return " ", "space"

    def _mark(self, cell: tuple[int, int], style: DrawingStyle) -> None:
        if STYLE_RANK[style] >= STYLE_RANK[self._styles.get(cell, "space")]:
            self._styles[cell] = style

    def _draw_braille_line(
        self, start: tuple[float, float], end: tuple[float, float], style: DrawingStyle
    ) -> None:
        x0, y0, x1, y1 = (2 * start[0] + 0.5, 4 * start[1] + 1.5, 2 * end[0] + 0.5, 4 * end[1] + 1.5)
        steps = max(1, math.ceil(max(abs(x1 - x0), abs(y1 - y0))))
        every = 3 if style == "beam" else 1
        aside = (1, 0) if abs(y1 - y0) > abs(x1 - x0) else (0, 1)
        for step in range(0, steps + 1, every):
            if style == "struck" and step % (2 * DASH) >= DASH:
                continue
            x, y = round(x0 + (x1 - x0) * step / steps), round(y0 + (y1 - y0) * step / steps)
            self._set_dot(x, y, style)
            if style == "group edge":
                self._set_dot(x + aside[0], y + aside[1], style)

    def _set_dot(self, x: int, y: int, style: DrawingStyle) -> None:
        cell = x // 2, y // 4
        if 0 <= cell[0] < self._width and 0 <= cell[1] < self._height:
            self._dots[cell] = self._dots.get(cell, 0) | _BRAILLE[y % 4][x % 2]
            self._mark(cell, style)

    def _draw_ascii_line(
        self, start: tuple[float, float], end: tuple[float, float], style: DrawingStyle
    ) -> None:
        (x0, y0), (x1, y1) = start, end
        steps = max(1, math.ceil(max(abs(x1 - x0), abs(y1 - y0))))
        letter = {"struck": ".", "beam": ":", "group edge": "*", "wrong": "x"}.get(style) or _line_character(
            x1 - x0, y1 - y0
        )
        for step in range(0, steps + 1, 2 if style == "struck" else 1):
            cell = round(x0 + (x1 - x0) * step / steps), round(y0 + (y1 - y0) * step / steps)
            if STYLE_RANK[style] >= STYLE_RANK[self._styles.get(cell, "space")]:
                self._letters[cell] = letter
                self._mark(cell, style)


def _line_character(across: float, down: float) -> str:
    """The character that looks most like a line in this direction; a character is twice as high as wide."""
    if abs(down) * 5 < abs(across):
        return "-"
    if abs(across) * 1.25 < abs(down):
        return "|"
    return "\\" if (across > 0) == (down > 0) else "/"
