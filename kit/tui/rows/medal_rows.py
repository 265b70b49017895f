"""A medal as a row of text, and as a drawing."""

from __future__ import annotations

from typing import Final

from kit.document.rows import Row, row
from kit.school.game.medal import Medal
from kit.tui.rows.medal_signs import MEDAL_SIGNS, MEDAL_STYLES


def medal_row(medal: Medal, *, is_new: bool) -> Row:
    """A medal that was earned. ``is_new``: whether it is better than those before."""
    better = " (new)" if is_new else ""
    return row((f"   {MEDAL_SIGNS[medal]} ", MEDAL_STYLES[medal]), (f"{medal.title}{better}", "bold"))


HIGH, HIGHEST = 30, 45
"""Rows of a screen from which on a medal is drawn, and from which on it is larger."""
CORNER, SMALL, LARGE = 10, 14, 20
"""Columns of a drawn medal; the one that stands in a corner is the disc alone."""
LETTERS: Final = {
    "B": ("####.", "#...#", "#...#", "####.", "#...#", "#...#", "####."),
    "S": (".####", "#....", "#....", ".###.", "....#", "....#", "####."),
    "G": (".###.", "#...#", "#....", "#.###", "#...#", "#...#", ".###."),
    "M": ("#...#", "##.##", "#.#.#", "#.#.#", "#...#", "#...#", "#...#"),
    "R": ("####.", "#...#", "#...#", "####.", "#.#..", "#..#.", "#...#"),
}
"""The letters that are cut out of medals, in pixels: two to the height of a character."""
HALVES: Final = {(False, False): " ", (True, False): "▀", (False, True): "▄", (True, True): "█"}
"""The character of an upper and a lower pixel."""
SPARKS: Final = 10
"""Pictures of the flourish around a new medal."""
SPARK_SIGNS: Final = "*.+'"
MARGIN, SPARK_COLUMNS = 3, 6
"""Columns before a drawn medal, and of the sparks after it."""


def medal_size(height: int) -> int:
    """Columns of a drawn medal on a screen of so many rows; 0: there is no room for it."""
    return 0 if height < HIGH else LARGE if height >= HIGHEST else SMALL


def drawn_columns(size: int) -> int:
    """Columns of a drawing with the room around it."""
    return MARGIN + size + SPARK_COLUMNS + 1


def medal_drawing(medal: Medal, size: int, spark: int = 0) -> list[Row]:
    """A medal with its letter, of ``size`` columns; none for 0. ``spark``: the number of a picture of the flourish, 0 for none:
    sparks beside it, and a line of light that goes down over it."""
    if medal is Medal.NONE or not size:
        return []
    drawn = [(line, "code") for line in _ribbon(size)] if size > CORNER else []
    drawn += [(line, MEDAL_STYLES[medal]) for line in _disc(MEDAL_SIGNS[medal], size)]
    rows = []
    for number, (line, style) in enumerate(drawn):
        sparks = "".join(
            SPARK_SIGNS[(number + column) % len(SPARK_SIGNS)]
            if spark and (7 * column + 5 * number + 3 * spark) % 11 < 2
            else " "
            for column in range(SPARK_COLUMNS)
        )
        is_lit = spark > 0 and number == (SPARKS - spark) * len(drawn) // SPARKS
        rows.append(row((f"{' ' * MARGIN}{line}", "bold" if is_lit else style), (sparks, "warn")))
    return rows


def _ribbon(size: int) -> list[str]:
    """Two bands that meet above the disc."""
    band, count = size // 4, size // 3
    rows = []
    for number in range(count):
        left = size // 10 + number * (size // 2 - band - size // 10) // max(1, count - 1)
        pixels = [left <= x < left + band for x in range(size)]
        rows.append([first or last for first, last in zip(pixels, reversed(pixels), strict=True)])
    return _encoded(rows)


def _disc(letter: str, size: int) -> list[str]:
    """A disc that a letter is cut out of."""
    middle, signs = (size - 1) / 2, LETTERS[letter]
    left, top = (size - len(signs[0])) // 2, (size - len(signs)) // 2

    def is_cut(x: int, y: int) -> bool:
        return 0 <= y - top < len(signs) and 0 <= x - left < len(signs[0]) and signs[y - top][x - left] == "#"

    return _encoded(
        [
            [
                (x - middle) ** 2 + (y - middle) ** 2 <= (size / 2) ** 2 and not is_cut(x, y)
                for x in range(size)
            ]
            for y in range(size)
        ]
    )


def _encoded(rows: list[list[bool]]) -> list[str]:
    """Two rows of pixels to a row of text."""
    padded = [[False] * len(rows[0])] * (len(rows) % 2) + rows
    return [
        "".join(HALVES[pair] for pair in zip(padded[number], padded[number + 1], strict=True))
        for number in range(0, len(padded), 2)
    ]
