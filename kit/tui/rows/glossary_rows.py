"""The glossary as rows of text. Pure."""

from __future__ import annotations

from collections.abc import Sequence

from kit.school.lessons.glossary import GlossaryTerm
from kit.tui.widgets.text_rows import Row, row


def glossary_rows(terms: Sequence[GlossaryTerm]) -> list[Row]:
    """Each term in bold, its meaning below it, and a blank row between two."""
    rows: list[Row] = []
    for each in terms:
        first, *rest = each.lines()
        rows += [row(("  " + first, "bold")), *(row(line) for line in rest), row()]
    return rows
