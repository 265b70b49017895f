"""A student's progress as rows of text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from kit.document.rows import Row, row
from kit.school.lessons.catalogue import LessonEntry
from kit.tui.rows.lesson_list_rows import TITLE
from kit.tui.rows.progress_marks import mark, progress_bar, stars

STARS_LEGEND: Final = ("an exercise: *** all points, **. half or more,", "*.. some, ... none yet")
"""What ``stars`` means, on the page of progress."""


def progress(shelf: Sequence[LessonEntry]) -> list[Row]:
    """All that was done of the lessons and their exercises."""
    readable = [each.progress for each in shelf if each.progress is not None]
    exercises = [(each, one.name) for each in readable for one in each.lesson.exercises]
    passed = sum(name in each.passed_exercises for each, name in exercises)
    made = [
        row(),
        row(
            "  ",
            ("Lessons", "bold"),
            f"  {sum(each.is_completed for each in readable)} of {len(shelf)} done,"
            f" {passed} of {len(exercises)} exercises passed",
        ),
        *(row((f"  {line}", "dim")) for line in STARS_LEGEND),
        row(),
    ]
    for entry in shelf:
        progress = entry.progress
        if progress is None:
            made.append(row(f" {entry.number:>3}  {mark(entry)} {entry.name}", (" cannot be read", "bad")))
            continue
        made.append(
            row(
                f" {entry.number:>3}  {mark(entry)} ",
                (entry.title[:TITLE], "bold" if entry.has_started else ""),
            )
        )
        if entry.has_started:
            done = ", ".join(f"{one.name} {stars(progress, one.name)}" for one in progress.lesson.exercises)
            made.append(row("          ", progress_bar(progress), (f"  {done}", "dim")))
    return made


def game_and_quiz_progress(game: Sequence[Row], quiz: Iterable[str], workspace: str) -> list[Row]:
    """Summarises progress beside the lessons: the game, the quiz, and how to export everything."""
    made = [row(), row("  ", ("Game", "bold")), row(), *game]
    made += [row(), row("  ", ("Quiz", "bold")), row(), *(row("  " + each) for each in quiz)]
    made += [
        row(),
        row("  ", ("Export your progress", "bold")),
        row(),
        row("  ", ("kit progress export FILE", "code"), " writes everything to one file,"),
        row("  for another machine or for your teacher."),
        row("  ", ("kit progress import FILE", "code"), " imports it there."),
        row(),
        row((f"  Saved in {workspace}", "dim")),
    ]
    return made
