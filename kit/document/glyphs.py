"""The characters that plots and diagrams are drawn with, and their width."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

WIDTH: Final = 79
"""Columns of a document on a terminal of 80."""


@dataclass(frozen=True, slots=True)
class PlotGlyphs:
    """Characters that plots are drawn with."""

    bars: tuple[str, ...]
    """Bars of the first, second and third group, distinct in shape."""
    point: str
    line: str
    encoder: str
    """What maps are drawn with."""


BLOCK_GLYPHS: Final = PlotGlyphs(bars=("█", "▒", "░"), point="o", line="·", encoder="braille")
ASCII_GLYPHS: Final = PlotGlyphs(bars=("#", "=", "-"), point="o", line=".", encoder="ascii")

_SIDES: Final = ((-1, 0, "-+<["), (1, 0, "-+>["), (0, -1, "|+^"), (0, 1, "|+v"))
"""Left, right, above and below a corner: columns and rows away, and what a line there looks like."""
_JOINTS: Final = dict(zip((1, 2, 3, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15), "───┘└┴┐┌┬│┤├┼", strict=True))
"""By the sides to which a line goes on: 1 left, 2 right, 4 above, 8 below."""
_HEADS: Final = dict(zip("<>^v", "◀▶▲▼", strict=True))


def diagram_lines(lines: Sequence[str]) -> list[str]:
    """A diagram that is written with ``-``, ``|``, ``+`` and ``<>^v``, with lines and arrow heads that are joined: as many
    lines, as long. What is no part of a line stays: a hyphen in a word, a minus, a sum.

    >>> print("\\n".join(diagram_lines(["+--+", "|a-b-->", "+--+ x + 1"])))
    ┌──┐
    │a-b─▶
    └──┘ x + 1
    """

    def at(column: int, number: int) -> str:
        line = lines[number] if 0 <= number < len(lines) else ""
        return line[column] if 0 <= column < len(line) else " "

    def drawn(column: int, number: int) -> str:
        sign = at(column, number)
        left, right = at(column - 1, number), at(column + 1, number)
        above, below = at(column, number - 1), at(column, number + 1)
        if sign == "-":
            return "─" if left in "-+<" or right in "-+>" else sign
        if sign == "|":
            return "│"
        if sign == "+":
            bits = sum(
                (at(column + x, number + y) in signs) << place for place, (x, y, signs) in enumerate(_SIDES)
            )
            return _JOINTS.get(bits, sign)
        is_alone = not (left.isalnum() or right.isalnum())  # a "v" may be a letter of a word
        is_head = (
            (sign == "<" and right == "-")
            or (sign == ">" and left == "-")
            or (sign == "^" and below in "|+" and is_alone)
            or (sign == "v" and above in "|+" and is_alone)
        )
        return _HEADS[sign] if is_head else sign

    return [
        "".join(drawn(column, number) for column in range(len(line))) for number, line in enumerate(lines)
    ]
