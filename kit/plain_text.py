"""Plain text in aligned columns, for terminals of 80 columns, pipes and screen readers."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Sequence
from itertools import zip_longest

WIDTH = 80
MIN_COLUMN = 12
GAP = "  "
INDENT = "  "


def table(rows: Sequence[Sequence[str]], width: int = WIDTH) -> list[str]:
    """The rows as lines of at most ``width`` columns: the widest cells are wrapped, the others left as they are."""
    return [line for lines in _wrapped(rows, width) for line in lines]


def blocks(rows: Iterable[Sequence[str]], width: int = WIDTH) -> list[str]:
    """The same, but what stands in the first column becomes a line above the rows that have it in common."""
    grouped: dict[str, list[Sequence[str]]] = {}
    for first, *others in rows:
        grouped.setdefault(first, []).append(others)
    lines = _wrapped([others for block in grouped.values() for others in block], width - len(INDENT))
    text: list[str] = []
    for first, block in grouped.items():
        text += textwrap.wrap(first, width)
        text += indented(line for _ in block for line in next(lines))
    return text


def indented(lines: Iterable[str]) -> list[str]:
    return [INDENT + line for line in lines]


def listed(names: Sequence[str], at_most: int = 4) -> str:
    """The names in a row, of many only the first."""
    if len(names) <= at_most:
        return ", ".join(names)
    return f"{', '.join(names[: at_most - 1])} and {len(names) - at_most + 1} more"


def _wrapped(rows: Sequence[Sequence[str]], width: int) -> Iterator[list[str]]:
    """The lines of each row."""
    widths = _fitted([max(1, *map(len, column)) for column in zip(*rows, strict=True)], width)
    for row in rows:
        cells = [textwrap.wrap(cell, limit) for cell, limit in zip(row, widths, strict=True)]
        lines = zip_longest(*cells, fillvalue="")
        yield [GAP.join(map(str.ljust, line, widths)).rstrip() for line in lines]


def _fitted(widths: list[int], width: int) -> list[int]:
    """The widths, of which the largest are cut until all fit beside one another."""
    widths = list(widths)
    while sum(widths) + len(GAP) * (len(widths) - 1) > width and max(widths) > MIN_COLUMN:
        widths[widths.index(max(widths))] -= 1
    return widths
