"""A title on a rule across a column."""

from __future__ import annotations

from kit.document.rows import Row, fitted, row


def ruled_title(name: str, width: int, note: str = "") -> Row:
    """A quiet rule with a name on it."""
    text = f" {name} "
    note = f" {note} " if note and len(text) + len(note) + 8 <= width else ""
    rule = "─" * max(0, width - 2 - len(text) - len(note) - (1 if note else 0))
    shown = row(("──", "dim"), (text, "title"), (rule, "dim"), (note, "dim"), ("─" if note else "", "dim"))
    return fitted(shown, width)
