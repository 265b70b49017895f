"""Keys in words: the line at the bottom of a screen, and its help page."""

from __future__ import annotations

from kit.tui.widgets.text_rows import Row, row

KeyTable = tuple[tuple[str, str], ...]
"""Keys, and what they do."""


def key_line(*keys: tuple[str, str]) -> Row:
    """All in one row."""
    parts = [part for key, text in keys for part in ((key, "bold"), f" {text} ")]
    return row(*parts)


def key_page(*tables: KeyTable) -> tuple[Row, ...]:
    """One below the other, the tables apart."""
    rows = [row()]
    for table in tables:
        rows += [*(row((f" {key:<17}", "bold"), text) for key, text in table), row()]
    return tuple(rows)
