"""What stands below the menu as rows of text: what there is to do today, the next level, and the medals by world."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from kit.document.blocks import CellStyle, Column, Table, Tone, ToneText, labelled_table
from kit.document.rows import Row, row
from kit.document.tables import table_rows
from kit.plain_text import counted, wrap
from kit.tui.rows.menu_rows import FRAME, MARGIN, PANEL_WIDTH, PICTURE, WIDE_ROWS
from kit.tui.rows.ruled_title import ruled_title

if TYPE_CHECKING:
    from kit.tui.student_store import StudentOverview

MOST_TRAININGS: Final = 3
"""Running trainings that are named."""


def next_level_rows(overview: StudentOverview, picture: Sequence[str], room: int = WIDE_ROWS) -> list[Row]:
    """The first level without a medal, as a picture, and its story where there is ``room`` for it, in rows; nothing where all
    levels have one."""
    level = overview.next_level
    if level is None:
        return []
    rows = [row(), row(" ", *ruled_title("next level", PICTURE - 1)), *(row(" ", each) for each in picture),
            row("  ", ("4", "press"), f"  {level.title}")]  # fmt: skip
    story = wrap(level.story or level.hint, PICTURE - MARGIN)
    return [*rows, *(row("  ", (each, "dim")) for each in story)] if len(rows) + len(story) <= room else rows


def today_rows(
    overview: StudentOverview, width: int = PANEL_WIDTH - FRAME, room: int = WIDE_ROWS
) -> list[Row]:
    """What is open today: the day's maze, the next medal in reach, questions that are due, trainings that run; those for which
    there is ``room``, in rows."""
    if overview.problem:
        return []
    maze = "driven today" if overview.has_run_today else "not driven yet"
    if overview.streak:
        maze += f", {counted(overview.streak, 'day')} in a row"
    lines = [("4", "maze", maze)]
    if overview.next_medal:
        lines.append(("4", "next", overview.next_medal))
    if overview.due:
        lines.append(("7", "quiz", f"{counted(overview.due, 'question')} due"))
    lines += [("5", "train", f"{name} is running") for name in overview.running[:MOST_TRAININGS]]
    if len(overview.running) > MOST_TRAININGS:
        lines.append(("", "", f"and {len(overview.running) - MOST_TRAININGS} more"))
    table = labelled_table(
        (ToneText(key, Tone.DIM), ToneText(word, Tone.DIM), text) for key, word, text in lines
    )
    rows = [row(" ", *ruled_title("today", width - 1))]
    for entry in table_rows(table, width - MARGIN).entries:
        if len(rows) + len(entry) <= room:
            rows += [row(" " * MARGIN, *each) for each in entry]
    return rows if len(rows) > 1 else []


def won_rows(overview: StudentOverview, width: int = PANEL_WIDTH - FRAME, room: int = WIDE_ROWS) -> list[Row]:
    """How many levels of each world of the game have a medal. Where there is not ``room``, in rows, for all worlds, those that
    have all medals are left out first, then the last ones."""
    worlds, most = overview.won, room - 2
    if len(worlds) > most:
        worlds = tuple(each for each in worlds if each[1] < each[2])[: max(0, most)]
    if not worlds:
        return []
    total = f"{sum(won for _, won, _ in overview.won)} of {sum(count for *_, count in overview.won)}"
    tones = [Tone.PLAIN if won else Tone.DIM for _, won, _ in worlds]
    table = Table(
        "medals",
        "",
        (Column("", CellStyle.TEXT), Column("")),
        tuple(
            (title, ToneText(f"{won} of {count:>2}", tone))
            for (title, won, count), tone in zip(worlds, tones, strict=True)
        ),
    )
    entries = table_rows(table, width - MARGIN).entries
    return [
        row(),
        row(" ", *ruled_title("medals", width - 1, total)),
        *(row(" " * MARGIN, *entry[0]) for entry in entries),
    ]
