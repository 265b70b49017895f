"""A stacked chart of shares over steps, such as how the episodes of each batch ended.

The horizontal scale is that of curves (``kit.render.curve``), so that one stands below the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.render.curve import MIN_COLUMNS_WITH_MARGIN, draw_value_axis, nice_ceiling
from kit.render.encode import UNICODE_GLYPHS, Frame, GlyphSet
from kit.render.frame_text import write_text
from kit.render.roles import Role

NEWEST: Final = "last batch"


@dataclass(frozen=True, slots=True)
class ChartPart:
    """One part of the whole: its name, and what it is drawn with."""

    name: str
    role: Role
    glyph: str


@dataclass(frozen=True, slots=True, eq=False)
class StackedCounts:
    """Counts per part, batch by batch."""

    x: FloatArray
    """(n,), rising: where each batch ends; the first begins at 0."""
    counts: IntArray
    """(n, parts); no batch is empty."""


def draw_stacked_chart(
    counts: StackedCounts,
    parts: Sequence[ChartPart],
    columns: int,
    rows: int,
    margin: int = 0,
    symbols: GlyphSet = UNICODE_GLYPHS,
) -> Frame:
    """A frame of ``columns`` x ``rows`` characters: the parts' names on top, where there is room with the percentages
    of the last batch, below them a column for each stretch of steps, the first part at the bottom."""
    frame = Frame.empty(columns, rows)
    top = int(rows >= 3)
    if top:
        _write_part_names(frame, counts, parts)
    left = max(margin, 5) if columns >= MIN_COLUMNS_WITH_MARGIN else 0
    height = rows - top
    if left and height >= 2:
        draw_value_axis(frame, range(top, rows), {top: "100%", rows - 1: "0%"}, left, symbols)
    if len(counts.x) and columns > left:
        levels = np.round(np.cumsum(_column_shares(counts, columns - left), axis=1) * height).astype(np.intp)
        above = np.arange(height, 0, -1)[:, None] - 1  # how many cells lie below each row
        for part in reversed(range(len(parts))):
            covered = above < levels[:, part]
            at = frame.glyphs[top:, left : left + len(levels)], frame.fg[top:, left : left + len(levels)]
            at[0][covered], at[1][covered] = ord(parts[part].glyph), parts[part].role
    return frame


def _column_shares(stacked: StackedCounts, width: int) -> FloatArray:
    """(used columns, parts) shares that add up to 1: of all batches that end in a column, else of the one that goes
    on through it."""
    right = nice_ceiling(float(stacked.x[-1]))
    used = max(1, int(np.ceil(stacked.x[-1] / right * width)))
    edges = np.arange(used + 1) / width * right
    first = np.searchsorted(stacked.x, edges[:-1], side="right")
    stop = np.searchsorted(stacked.x, edges[1:], side="right")
    first = np.minimum(first, len(stacked.x) - 1)
    total = np.concatenate((np.zeros((1, stacked.counts.shape[1])), np.cumsum(stacked.counts, axis=0)))
    counts = total[np.maximum(stop, first + 1)] - total[first]
    divided: FloatArray = counts / counts.sum(axis=1, keepdims=True)
    return divided


def _write_part_names(frame: Frame, stacked: StackedCounts, parts: Sequence[ChartPart]) -> None:
    names = [f"{part.glyph}{part.name}" for part in parts]
    if len(stacked.x):
        newest = (stacked.counts[-1] / stacked.counts[-1].sum()).tolist()
        with_shares = [f"{name} {share:.0%}" for name, share in zip(names, newest, strict=True)]
        named = " ".join(with_shares)
        if len(named) + 1 + len(NEWEST) <= frame.shape[1]:
            names = with_shares
            write_text(frame, 0, len(named) + 1, NEWEST)
    column = 0
    for part, name in zip(parts, names, strict=True):
        write_text(frame, 0, column, name, part.role)
        column += len(name) + 1
