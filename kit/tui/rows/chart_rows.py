"""Charts of blocks, as rows of text: of a laser's distances, of values over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from kit.document.rows import Row, row
from kit.tui.rows.ruled_title import ruled_title

CHART_ROWS: Final = 5
CHART_LABEL: Final = 6
"""Columns of the scale before the bars."""
WIDEST_BAR: Final = 6
"""Columns of a value in a stretched chart."""

_EIGHTHS: Final = " ▁▂▃▄▅▆▇█"


def laser_chart(laser: Sequence[float], width: int, rows: int = CHART_ROWS) -> list[Row]:
    """Bars of the distance [m] by direction, from behind on the left over ahead in the middle to behind on the right."""
    ranges = laser[::-1]
    bars = width - CHART_LABEL
    columns = (bar * len(ranges) // bars for bar in range(bars + 1))
    heights = []
    for start, stop in pairwise(columns):
        seen = filter(math.isfinite, ranges[start : max(stop, start + 1)])
        heights.append(min(seen, default=0.0))
    return _bar_rows(heights, max(heights, default=0.0) or 1.0, rows, "m")


def time_chart(
    values: Sequence[float], width: int, least: float, window: int, rows: int = CHART_ROWS
) -> list[Row]:
    """The newest ``window`` values, the last of them on the right, from the middle row up and down where some are negative. Of
    several values in one column the largest is shown."""
    room = width - CHART_LABEL
    newest = list(values)[-window:]
    shown = [0.0] * (window - len(newest)) + newest
    starts = [bar * window // room for bar in range(room + 1)]
    bars = [max(shown[start : max(end, start + 1)], key=abs) for start, end in pairwise(starts)]
    top = _top(max((abs(value) for value in bars), default=0.0), least)
    if min(bars, default=0.0) > -0.05 * top:
        return _bar_rows(bars, top, rows, "")
    middle = rows // 2
    return _two_sided(bars, top / middle, middle, rows - middle - 1)


def _top(largest: float, least: float) -> float:
    """The end of a scale in steps of ``least``."""
    return max(least, math.ceil(largest / least - 1e-9) * least)


def _two_sided(values: Sequence[float], step: float, above: int, below: int) -> list[Row]:
    """Bars up and down from an axis, each row of them ``step`` high."""
    raised = [max(value, 0.0) for value in values]
    upper = _bar_rows(raised, step * above, above, "", has_zero=False) if above else []
    lower = [
        row(
            (f"{-step * below:<{CHART_LABEL}.1f}" if number == below - 1 else " " * CHART_LABEL, "dim"),
            ("".join(_downward_block(-value / step - number) for value in values), "code"),
        )
        for number in range(below)
    ]
    axis = row(("   0  ", "dim"), ("".join("─" if value == 0.0 else "━" for value in values), "dim"))
    return [*upper, axis, *lower]


def stretched_chart(
    title: str, note: str, values: Sequence[float], width: int, least: float, rows: int
) -> list[Row]:
    """A chart below its title of values from the first to the last, stretched over ``width`` columns as far as few of them
    reach, its axis where both sides have the rows that they need."""
    bars = min(width - CHART_LABEL, WIDEST_BAR * len(values))
    shown = [values[min(len(values) - 1, bar * len(values) // bars)] for bar in range(bars)]
    high, low = max(0.0, *shown), -min(0.0, *shown)
    if low <= 0.05 * _top(high, least):
        return [ruled_title(title, width, note), *_bar_rows(shown, _top(high, least), rows, "")]

    def step_of(above: int) -> float:
        return max(least / rows, low / (rows - 1 - above), high / above if above else 0.0)

    above = min(range(1 if high else 0, rows - 1), key=step_of)
    below = rows - 1 - above
    return [ruled_title(title, width, note), *_two_sided(shown, step_of(above), above, below)]


def _downward_block(share: float) -> str:
    """A character filled from its top: half and whole are all there are."""
    return "█" if share >= 0.75 else "▀" if share >= 0.1 else " "


def column_chart(shares: Sequence[float], rows: int) -> list[str]:
    """A column for each share, 0 to 1 of the height, as ``rows`` lines of text."""
    return [
        "".join(_EIGHTHS[min(8, max(0, round((share * rows - line) * 8)))] for share in shares)
        for line in range(rows - 1, -1, -1)
    ]


def _bar_rows(
    values: Sequence[float], top: float, rows: int, unit: str, *, has_zero: bool = True
) -> list[Row]:
    lines = []
    for number, glyphs in enumerate(column_chart([value / top for value in values], rows)):
        label = " " * CHART_LABEL
        if number == 0:
            label = f"{top:4.1f}{unit}".ljust(CHART_LABEL)
        elif number == rows - 1 and has_zero:
            label = f"   0{unit:<2}"
            glyphs = glyphs.replace(" ", "_")  # the axis
        lines.append(row((label, "dim"), (glyphs, "code")))
    return lines
