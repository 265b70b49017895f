"""The list of lessons as rows of text, and what is known of each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from kit.document.layout import Page, rows_of
from kit.document.rows import TEXT_WIDTH, Row, row, text_width
from kit.plain_text import wrap
from kit.school.game.levels import GameLevel
from kit.school.lessons.catalogue import LessonEntry
from kit.tui.rows.lesson_rows import steps_table
from kit.tui.rows.progress_marks import STEP_DONE, mark, progress_bar

TITLE: Final = 40
HEADER: Final = f"{'':9} {'lesson':<{TITLE}}    time  steps, {STEP_DONE} done"


def lines(shelf: Sequence[LessonEntry], chosen: LessonEntry | None) -> list[tuple[LessonEntry | None, Row]]:
    """The list of all lessons: each line with its lesson, or with None where a unit begins."""
    made: list[tuple[LessonEntry | None, Row]] = []
    for each in shelf:
        if each.opened_unit is not None:
            made.append((None, row("  ", (f"{each.opened_unit.letter}  {each.opened_unit.title}", "dim"))))
        made.append((each, line(each, each is chosen)))
    return made


def line(entry: LessonEntry, chosen: bool) -> Row:
    """One lesson of the list: number, title, mark, minutes, steps."""
    style = "chosen" if chosen else ""
    title = entry.title if len(entry.title) <= TITLE else entry.title[: TITLE - 3] + "..."
    head = row(
        (">" if chosen else " ", "bold"),
        (f"{entry.number:>3}  ", style),
        (mark(entry), style),
        (f" {title:<{TITLE}}", style),
    )
    progress = entry.progress
    if progress is None:
        return (*head, (" cannot be read", "bad"))
    minutes = f" {progress.lesson.minutes:>3} min"
    return (*head, *row((minutes, style or "dim"), "  ", progress_bar(progress)))


def summary(entry: LessonEntry, rows: int, width: int) -> list[Row]:
    """What the chosen lesson is about, and what one can do after it; at most this many rows on a screen of
    ``width``."""
    room = text_width(width)
    lesson = entry.lesson
    if lesson is None:
        lines = [each for part in entry.problem.splitlines() for each in wrap(part, room)]
        return [row("  ", (each, "bad")) for each in lines[:rows]]
    made = []
    if entry.opened_unit is not None:
        made += [row("  ", (each, "dim")) for each in wrap(entry.opened_unit.opener, room)]
    made += [row("  ", each) for each in wrap(lesson.summary, room)]
    for outcome in lesson.outcomes:
        made += [row("  ", (each, "dim")) for each in wrap(f"- {outcome}", room, "", "  ")]
    return made[:rows]


def details(entry: LessonEntry, levels: Sequence[GameLevel], width: int) -> list[Row]:
    """All of the chosen lesson, for a screen with room beside the list. ``levels``: those that it opens."""
    lesson, progress = entry.lesson, entry.progress
    if lesson is None or progress is None:
        return [
            row((f"{entry.number}  {entry.name}", "bold")),
            row(),
            *summary(entry, len(entry.problem), width),
        ]
    room = min(width, TEXT_WIDTH)
    done = f"{progress.completed_count} of {len(lesson.steps)} steps done"
    opener = entry.opened_unit.opener if entry.opened_unit is not None else ""
    made = [
        *(row((each, "bold")) for each in wrap(f"{entry.number}  {lesson.title}", room)),
        row((f"{lesson.minutes} min, {done}", "dim")),
        row(),
        *(row((each, "dim")) for each in (wrap(opener, room) if opener else ())),
        *(row(each) for each in wrap(lesson.summary, room)),
        row(),
        row(("Afterwards you can:", "bold")),
    ]
    for outcome in lesson.outcomes:
        made += [row(each) for each in wrap(f"- {outcome}", room, "", "  ")]
    made += [row(), row(("Steps", "bold"))]
    made += rows_of([steps_table(progress)], Page(room))
    if levels:
        titles = ", ".join(level.title for level in levels)
        made += [row(), *(row((each, "dim")) for each in wrap(f"Opens in the game: {titles}", room))]
    return made
