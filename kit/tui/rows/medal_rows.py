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


HIGH: Final = 30
"""Rows of a screen from which on the medal is drawn."""
RIBBON: Final = (
    "  ▀██▄     ▄██▀",
    "    ▀██▄ ▄██▀",
)
DISC: Final = (
    "    ▄▄█████▄▄",
    "  ▄███████████▄",
    "  █████ {} █████",
    "  ▀███████████▀",
    "    ▀▀█████▀▀",
)
SPARK_SIGNS: Final = "*.+'"
DISC_COLUMNS, SPARK_COLUMNS = 18, 6
DRAWN_COLUMNS: Final = 4 + DISC_COLUMNS + SPARK_COLUMNS
"""Of a drawn medal, with the room around it."""


def medal_drawing(medal: Medal, height: int, spark: int = 0) -> list[Row]:
    """A medal with its letter; none on a screen of too small a ``height``. ``spark``: the number of a picture of joy around it,
    0 for none."""
    if medal is Medal.NONE or height < HIGH:
        return []
    drawn = [(line, "code") for line in RIBBON]
    drawn += [(line.format(MEDAL_SIGNS[medal]), MEDAL_STYLES[medal]) for line in DISC]
    rows = []
    for number, (line, style) in enumerate(drawn):
        sparks = "".join(
            SPARK_SIGNS[(number + column) % len(SPARK_SIGNS)]
            if spark and (7 * column + 5 * number + 3 * spark) % 11 < 2
            else " "
            for column in range(SPARK_COLUMNS)
        )
        rows.append(row((f"   {line:<{DISC_COLUMNS}}", style), (sparks, "warn")))
    return [*rows, row(" " * DRAWN_COLUMNS)]
