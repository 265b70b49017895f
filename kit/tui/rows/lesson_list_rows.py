"""The list of lessons and a student's progress, as rows of text. Pure."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from typing import Final

from kit.school.lessons.catalogue import LessonEntry
from kit.school.lessons.lesson_progress import LessonProgress
from kit.tui.rows.lesson_rows import progress_bar
from kit.tui.widgets.text_rows import Row, row

TITLE: Final = 46
WIDTH: Final = 76
STARS: Final = 3


def mark(entry: LessonEntry) -> str:
    """Done, begun, or neither; also where there is no colour."""
    if entry.progress is None:
        return "[!]"
    return "[x]" if entry.is_completed else "[~]" if entry.has_started else "[ ]"


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
    return (*head, (f" {progress.lesson.minutes:>3} min  ", style or "dim"), (progress_bar(progress), ""))


def summary(entry: LessonEntry, rows: int) -> list[Row]:
    """What the chosen lesson is about, and what one can do after it; at most so many rows."""
    lesson = entry.lesson
    if lesson is None:
        lines = [each for part in entry.problem.splitlines() for each in textwrap.wrap(part, WIDTH)]
        return [row("  ", (each, "bad")) for each in lines[:rows]]
    made = []
    if entry.opened_unit is not None:
        made += [row("  ", (each, "dim")) for each in textwrap.wrap(entry.opened_unit.opener, WIDTH)]
    made += [row("  ", each) for each in textwrap.wrap(lesson.summary, WIDTH)]
    for outcome in lesson.outcomes:
        made += [
            row("  ", (each, "dim")) for each in textwrap.wrap(f"- {outcome}", WIDTH, subsequent_indent="  ")
        ]
    return made[:rows]


def stars(progress: LessonProgress, exercise: str) -> str:
    """``***`` for everything, ``**.`` from half of the points on, ``*..`` for some, ``...`` for none yet; one more for a
    program that was defended."""
    share = progress.best_shares.get(exercise, 0.0)
    count = STARS if exercise in progress.passed_exercises else 2 if share >= 0.5 else 1 if share > 0 else 0
    return "*" * count + "." * (STARS - count) + "*" * (exercise in progress.defended_exercises)


def progress(shelf: Sequence[LessonEntry], quiz: Iterable[str], workspace: str) -> list[Row]:
    """All that was done: lessons and their exercises, then the quiz, then how to take it along."""
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
    made += [row(), row("  ", ("Quiz", "bold")), row(), *(row("  " + each) for each in quiz)]
    made += [
        row(),
        row("  ", ("Take it along", "bold")),
        row(),
        row(
            "  ", ("kit progress export FILE", "code"), " writes everything to one file: for another machine,"
        ),
        row("  or for your teacher. ", ("kit progress import FILE", "code"), " takes it in there."),
        row(),
        row((f"  Kept in {workspace}", "dim")),
    ]
    return made
