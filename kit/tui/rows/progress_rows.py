"""A student's progress as rows of text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from kit.document.rows import Row, row
from kit.school.lessons.catalogue import LessonEntry
from kit.tui.rows.lesson_list_rows import TITLE
from kit.tui.rows.progress_marks import mark, progress_bar, stars

STARS_LEGEND: Final = ("an exercise: *** all points, **. half", "or more, *.. some, ... none yet")
"""What ``stars`` means, on the page of progress."""


def summary_rows(
    game: Sequence[Row], quiz: Iterable[str], shelf: Sequence[LessonEntry], workspace: str
) -> list[Row]:
    """The game, the quiz, how to export everything, and how much of the lessons is done."""
    readable = [each.progress for each in shelf if each.progress is not None]
    exercises = [(each, one.name) for each in readable for one in each.lesson.exercises]
    passed = sum(name in each.passed_exercises for each, name in exercises)
    return [
        row(),
        row("  ", ("Game", "bold")),
        row(),
        *game,
        row(),
        row("  ", ("Quiz", "bold")),
        row(),
        *(row("  " + each) for each in quiz),
        row(),
        row("  ", ("Export your progress", "bold")),
        row(),
        row("  ", ("kit progress export FILE", "code"), " writes it to a"),
        row("  file, for another machine or your teacher;"),
        row("  ", ("kit progress import FILE", "code"), " reads it there."),
        row((f"  Saved in {workspace}", "dim")),
        row(),
        row("  ", ("Lessons", "bold")),
        row(),
        row(f"  {sum(each.is_completed for each in readable)} of {len(shelf)} done"),
        row(f"  {passed} of {len(exercises)} exercises passed"),
        *(row((f"  {line}", "dim")) for line in STARS_LEGEND),
    ]


def lesson_rows(shelf: Sequence[LessonEntry]) -> list[Row]:
    """A row for each lesson, and below one that was begun its steps and exercises by name."""
    made = []
    for entry in shelf:
        made.append(_lesson_row(entry))
        progress = entry.progress
        if progress is not None and entry.has_started:
            done = ", ".join(f"{one.name} {stars(progress, one.name)}" for one in progress.lesson.exercises)
            made.append(row("          ", progress_bar(progress), (f"  {done}", "dim")))
    return made


def short_lesson_rows(shelf: Sequence[LessonEntry]) -> list[Row]:
    """A row for each lesson, with the stars of its exercises where it was begun."""
    made = []
    for entry in shelf:
        progress, parts = entry.progress, _lesson_row(entry)
        if progress is not None and entry.has_started:
            earned = " ".join(stars(progress, one.name) for one in progress.lesson.exercises)
            blanks = " " * max(0, TITLE - len(entry.title))
            parts = (*parts, (f"{blanks}  {earned}", "dim"))
        made.append(parts)
    return made


def _lesson_row(entry: LessonEntry) -> Row:
    """Number, mark and title."""
    head = f" {entry.number:>3}  {mark(entry)} "
    if entry.progress is None:
        return row(f"{head}{entry.name}", (" cannot be read", "bad"))
    return row(head, (entry.title[:TITLE], "bold" if entry.has_started else ""))
