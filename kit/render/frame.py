"""Frames of characters, and the spans that differ between two frames."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

BLANK = ord(" ")

MERGE_GAP = 8
"""Unchanged characters that are cheaper to send again than to jump over: moving the cursor and naming the
colour again cost about as many bytes as eight characters."""


class CellSpan(NamedTuple):
    """The characters ``start`` to ``stop`` (exclusive) of a row."""

    row: int
    start: int
    stop: int


class StyledRun(NamedTuple):
    """Characters with one foreground and one background role."""

    text: str
    fg: int
    bg: int


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """Rows of characters, each with a foreground and a background role, 0 for none."""

    glyphs: NDArray[np.uint32]
    """(rows, columns) Unicode code points, all one character wide."""
    fg: NDArray[np.uint8]
    bg: NDArray[np.uint8]

    @classmethod
    def empty(cls, columns: int, rows: int) -> Frame:
        shape = (rows, columns)
        return cls(
            np.full(shape, BLANK, dtype=np.uint32), np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
        )

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns = self.glyphs.shape
        return rows, columns

    def text(self, row: int) -> str:
        return str(self.glyphs[row].astype("<u4").tobytes(), "utf-32-le")

    def rows(self) -> list[str]:
        """The characters alone, row by row, without the blanks at the ends."""
        return [self.text(row).rstrip() for row in range(self.shape[0])]

    def runs(self, row: int) -> Iterator[StyledRun]:
        """Yields the row, cut where foreground or background changes. A blank takes the foreground before it,
        since it is invisible: fewer cuts, fewer bytes."""
        text, fg, bg = self.text(row), self.fg[row], self.bg[row]
        if not len(fg):
            return
        visible = (self.glyphs[row] != BLANK) | (bg != 0)
        last = np.maximum.accumulate(np.where(visible, np.arange(len(fg)), 0))
        pairs = np.where(bg[last] == 0, fg[last], fg).astype(np.int32) * 256 + bg
        starts = np.concatenate(([0], np.flatnonzero(pairs[1:] != pairs[:-1]) + 1))
        cuts = pairwise((*starts.tolist(), len(pairs)))
        for (start, stop), pair in zip(cuts, pairs[starts].tolist(), strict=True):
            yield StyledRun(text[start:stop], pair >> 8, pair & 255)


def changed_spans(before: Frame | None, after: Frame, gap: int = MERGE_GAP) -> list[CellSpan]:
    """Returns the spans in which ``after`` differs, merged where ``gap`` or fewer characters lie between.

    Without a frame before, or after one of another size, everything differs.
    """
    rows, columns = after.shape
    if before is None or before.shape != after.shape:
        return [CellSpan(row, 0, columns) for row in range(rows)] if columns else []
    changed = before.glyphs != after.glyphs
    changed |= before.fg != after.fg
    changed |= before.bg != after.bg
    spans = []
    for row in np.flatnonzero(changed.any(axis=1)).tolist():
        where = np.flatnonzero(changed[row])
        cuts = np.flatnonzero(np.diff(where) > gap + 1)
        starts = where[np.concatenate(([0], cuts + 1))]
        stops = where[np.concatenate((cuts, [-1]))] + 1
        spans += [
            CellSpan(row, start, stop) for start, stop in zip(starts.tolist(), stops.tolist(), strict=True)
        ]
    return spans
