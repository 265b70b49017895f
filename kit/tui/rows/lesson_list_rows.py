"""The list of lessons and a student's progress, as rows of text. Pure."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from typing import Final

from kit.school.lessons.catalogue import Entry
from kit.school.lessons.lesson_progress import Standing
from kit.tui.rows.lesson_rows import progress_bar
from kit.tui.widgets.text_rows import Row, row

TITLE: Final = 46
WIDTH: Final = 76
STARS: Final = 3


def mark(entry: Entry) -> str:
    """Done, begun, or neither; also where there is no colour."""
    if entry.standing is None:
        return "[!]"
    return "[x]" if entry.is_done else "[~]" if entry.is_begun else "[ ]"


def line(entry: Entry, chosen: bool) -> Row:
    """One lesson of the list: number, title, mark, minutes, steps."""
    style = "bold" if chosen else ""
    title = entry.title if len(entry.title) <= TITLE else entry.title[: TITLE - 3] + "..."
    head = row(
        (">" if chosen else " ", "bold"),
        (f" {entry.number:>2}  ", style),
        mark(entry),
        (f" {title:<{TITLE}}", style),
    )
    stand = entry.standing
    if stand is None:
        return (*head, (" cannot be read", "bad"))
    return (*head, (f" {stand.lesson.minutes:>3} min  ", "dim"), (progress_bar(stand), ""))


def summary(entry: Entry, rows: int) -> list[Row]:
    """What the chosen lesson is about, and what one can do after it; at most so many rows."""
    lesson = entry.lesson
    if lesson is None:
        lines = [each for part in entry.problem.splitlines() for each in textwrap.wrap(part, WIDTH)]
        return [row("  ", (each, "bad")) for each in lines[:rows]]
    made = [row("  ", each) for each in textwrap.wrap(lesson.summary, WIDTH)]
    for outcome in lesson.outcomes:
        made += [
            row("  ", (each, "dim")) for each in textwrap.wrap(f"- {outcome}", WIDTH, subsequent_indent="  ")
        ]
    return made[:rows]


def stars(standing: Standing, exercise: str) -> str:
    """``***`` for everything, ``**.`` from half of the points on, ``*..`` for some, ``...`` for none yet."""
    share = standing.best.get(exercise, 0.0)
    count = STARS if exercise in standing.passed else 2 if share >= 0.5 else 1 if share > 0 else 0
    return "*" * count + "." * (STARS - count)


def progress(shelf: Sequence[Entry], quiz: Iterable[str], workspace: str) -> list[Row]:
    """All that was done: lessons and their exercises, then the quiz, then how to take it along."""
    readable = [each.standing for each in shelf if each.standing is not None]
    exercises = [(each, one.name) for each in readable for one in each.lesson.exercises]
    passed = sum(name in each.passed for each, name in exercises)
    made = [
        row(),
        row(
            "  ",
            ("Lessons", "bold"),
            f"  {sum(each.is_done for each in readable)} of {len(shelf)} done,"
            f" {passed} of {len(exercises)} exercises passed",
        ),
        row(),
    ]
    for entry in shelf:
        stand = entry.standing
        if stand is None:
            made.append(row(f"  {entry.number:>2}  {mark(entry)} {entry.name}", (" cannot be read", "bad")))
            continue
        made.append(
            row(
                f"  {entry.number:>2}  {mark(entry)} ",
                (entry.title[:TITLE], "bold" if entry.is_begun else ""),
            )
        )
        if entry.is_begun:
            done = ", ".join(f"{one.name} {stars(stand, one.name)}" for one in stand.lesson.exercises)
            made.append(row("          ", progress_bar(stand), (f"  {done}", "dim")))
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
