"""A student's progress as rows of text, section by section."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import date, timedelta
from typing import Final

from kit.document.blocks import Block, Cell, CellStyle, Column, Table, Text, Tone, ToneText
from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, Row, at_both_edges, row, row_width
from kit.school.game.medal_in_reach import MedalInReach
from kit.school.lessons.catalogue import LessonEntry
from kit.tui.rows.lesson_list_rows import TITLE
from kit.tui.rows.progress_marks import mark, progress_bar, stars
from kit.tui.rows.ruled_title import ruled_title

STARS_LEGEND: Final = ("an exercise: *** all points, **. half", "or more, *.. some, ... none yet")
"""What ``stars`` means, on the page of progress."""
WEEKDAYS: Final = ("Mon", "", "Wed", "", "Fri", "", "Sun")
MOST_WEEKS: Final = 26
HEAD: Final = 10
"""Columns before a lesson's title."""
STEPS: Final = 15
"""Columns of a lesson's steps."""
ROOM_FOR_STEPS: Final = 80
EARNED: Final = 11
"""Columns of the stars of three exercises."""
BUSY: Final = ((1, "░"), (5, "▒"), (15, "█"))
"""From how many things that were learned on a day on which sign stands for it."""


def section(title: str, rows: Sequence[Row], columns: int) -> list[Row]:
    """Rows below their title, with an empty one after them."""
    return [row("  ", *ruled_title(title, columns - 2 * MARGIN)), *rows, row()]


def section_of(title: str, blocks: Sequence[Block], columns: int) -> list[Row]:
    """Blocks below their title."""
    return section(title, rows_of(blocks, Page(columns - 2 * MARGIN, MARGIN)), columns)


def lesson_counts(shelf: Sequence[LessonEntry]) -> list[Row]:
    """How much of the lessons is done, and what their stars mean."""
    readable = [each.progress for each in shelf if each.progress is not None]
    exercises = [(each, one.name) for each in readable for one in each.lesson.exercises]
    passed = sum(name in each.passed_exercises for each, name in exercises)
    return [
        row(f"  {sum(each.is_completed for each in readable)} of {len(shelf)} lessons"),
        row(f"  {passed} of {len(exercises)} exercises passed"),
        *(row((f"  {line}", "dim")) for line in STARS_LEGEND),
    ]


def export_blocks(workspace: str) -> list[Block]:
    """How to take everything along."""
    return [
        Text("`kit progress export FILE` writes it to a file, for another machine or your teacher."),
        Text("`kit progress import FILE` reads it there.", is_tight=True),
        Text(f"Saved in {workspace}", Tone.DIM, is_tight=True),
    ]


def calendar_rows(days: Mapping[date, int], today: date, columns: int) -> list[Row]:
    """The last weeks, a column each, with a sign for each day that says how much was learned on it; the name of a month above the
    week in which it begins."""
    label = len(WEEKDAYS[0]) + MARGIN + 1
    weeks = max(1, min(MOST_WEEKS, (columns - label - MARGIN) // 2))
    monday = today - timedelta(days=today.weekday() + 7 * (weeks - 1))
    starts = [monday + timedelta(weeks=number) for number in range(weeks)]
    months = [" "] * (2 * weeks + 2)
    for number, start in enumerate(starts):
        last = min(start + timedelta(days=6), today)
        if last.day <= (last - start).days + 1:  # the first of its month is one of them
            months[2 * number : 2 * number + 3] = f"{last:%b}"
    rows = [row(" " * label, ("".join(months).rstrip(), "dim"))]
    for weekday, name in enumerate(WEEKDAYS):
        parts: list[str | tuple[str, str]] = [(f"  {name:<{label - MARGIN}}", "dim")]
        for start in starts:
            day = start + timedelta(days=weekday)
            sign = next((sign for least, sign in reversed(BUSY) if days.get(day, 0) >= least), "")
            shown = (f"{sign} ", "good") if sign else ("· " if day <= today else "  ", "dim")
            parts.append(shown)
        rows.append(row(*parts))
    legend = [part for least, sign in BUSY for part in ((sign, "good"), (f" {least} or more  ", "dim"))]
    return [*rows, row(" " * label, *legend)]


def reach_table(medals: Iterable[MedalInReach]) -> Table:
    """The next medals, with what was driven and what they ask for."""
    rows: list[tuple[Cell, ...]] = [
        (
            each.level.title,
            ToneText(each.driver.phrase, Tone.DIM),
            ToneText(f"{each.seconds:.2f} s", Tone.DIM),
            ToneText(each.medal.title, Tone.BOLD),
            f"at {each.asked:.2f} s",
        )
        for each in medals
    ]
    text = Column("", CellStyle.TEXT)
    return Table("reach", "", (text, text, Column(""), text, Column("")), tuple(rows))


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


def short_lesson_rows(shelf: Iterable[LessonEntry], columns: int) -> list[Row]:
    """A row for each lesson, with its steps where there is room, and the stars of its exercises where it was begun."""
    made = []
    for entry in shelf:
        progress, parts = entry.progress, _lesson_row(entry)
        if progress is not None:
            bar = f"{progress_bar(progress):<{STEPS}}" if columns >= ROOM_FOR_STEPS else ""
            earned = " ".join(stars(progress, one.name) for one in progress.lesson.exercises)
            earned = f"{earned:<{EARNED}}"
            beside = row(" ", bar, (earned, "dim")) if entry.has_started else row(" ", bar)
            parts = at_both_edges(parts, (), min(HEAD + TITLE + 1, columns - row_width(beside))) + beside
        made.append(parts)
    return made


def _lesson_row(entry: LessonEntry) -> Row:
    """Number, mark and title."""
    head = f" {entry.number:>3}  {mark(entry)} "
    if entry.progress is None:
        return row(f"{head}{entry.name}", (" cannot be read", "bad"))
    return row(head, (entry.title[:TITLE], "bold" if entry.has_started else ""))
