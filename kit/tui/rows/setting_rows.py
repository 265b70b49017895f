"""Settings of a new training as rows of text: name, value, meaning."""

from __future__ import annotations

from collections.abc import Sequence

from kit.document.rows import Row, row
from kit.plain_text import wrap


def _end_of(value: str, room: int) -> str:
    """A value in its room: of a path that is too long, the end says which file it is."""
    return value if len(value) <= room else f"...{value[3 - room :]}"


def settings(entries: Sequence[tuple[str, str, str]], chosen: int, width: int) -> list[Row]:
    """One block for each setting: its name, its value and what it means."""
    rows: list[Row] = []
    for number, (name, value, about) in enumerate(entries):
        is_chosen = number == chosen
        rows.append(
            row(
                (">" if is_chosen else " ", "bold"),
                (f" {name:12}", "bold" if is_chosen else ""),
                (_end_of(value, max(4, width - 15)), "bold"),
            )
        )
        rows += [row("              ", (line, "dim")) for line in wrap(about, max(20, width - 15))]
        rows.append(row())
    return rows
