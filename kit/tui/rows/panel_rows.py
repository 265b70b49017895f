"""Panels of a large screen as rows of text, each with its title on a rule."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from kit.dialogue.dialogue import Panel
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row
from kit.tui.rows.ruled_title import ruled_title

LEAST_PANEL: Final = 5
"""Rows of a panel that is cut, at least."""


def panel_rows(panels: Sequence[Panel], width: int, room: int, *, upwards: bool = False) -> list[Row]:
    """The panels below each other, each with its title on a rule; what does not fit in ``room`` rows is left out, the last
    panel that fits in part is cut, at an empty row where one keeps half of it. ``upwards``: the first is the lowest, so that at the
    bottom of a page it stays where it is when there is less room.

    >>> from kit.document.blocks import Text
    >>> from kit.document.rows import row_text
    >>> panels = [Panel("one", (Text("first"),)), Panel("two", (Text("second"),))]
    >>> [row_text(each) for each in panel_rows(panels, 12, 5)]
    ['', '── one ─────', 'first']
    """
    made: list[Row] = []
    for panel in panels:
        rows = [row(), ruled_title(panel.title, width), *rows_of(panel.blocks, Page(width))]
        left = room - len(made)
        if len(rows) > left:
            if left < LEAST_PANEL:
                break
            rows = _whole_sections(rows[:left])
        made = [*rows, *made] if upwards else [*made, *rows]
    return made


def _whole_sections(rows: list[Row]) -> list[Row]:
    """The rows up to the last empty one below the title; where that would leave out most the last row says that more follow."""
    end = max(number for number, each in enumerate(rows) if not each)
    return rows[:end] if 2 * end >= len(rows) else [*rows[:-1], row(("...", "dim"))]
