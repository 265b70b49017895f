"""What was done in the lessons, by lesson, exercise and student; and what students wrote."""

from __future__ import annotations

from statistics import median
from typing import Final

import numpy as np

from kit.school.quiz.answers import Outcome
from kit.school.report.chapters.setting import Setting
from kit.school.report.document import Block, Cell, Chapter, Column, Said, Style, Table, Text
from kit.school.report.work import PAUSE, ExerciseWork, LessonWork, lessons_of

MOST_LOST: Final = 2
"""Criteria named for an exercise."""


def lessons(setting: Setting) -> Chapter | None:
    """Attempts, points and time."""
    work = setting.data.work
    names = lessons_of(work)
    if not names:
        return None
    by_lesson = {name: [each[name] for each in work if name in each] for name in names}
    tables = (_by_lesson(by_lesson), _by_exercise(by_lesson), _by_student(setting))
    blocks: list[Block] = [table for table in tables if table.rows]
    minutes = int(PAUSE.total_seconds() // 60)
    blocks.append(
        Text(
            f"Time is what lies between two entries of a lesson; more than {minutes} minutes without one count as a "
            "pause. Points are the best attempt's. Attempts that broke on our side are not counted."
        )
    )
    return Chapter("lessons", "Lessons", tuple(blocks))


def _by_lesson(by_lesson: dict[str, list[LessonWork]]) -> Table:
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            name,
            len(some),
            float(median(len(each.steps) for each in some)),
            sum(each.attempts for each in some),
            _share(sum(each.points for each in some), sum(each.max_points for each in some)),
            _share(sum(each.predicted_right for each in some), sum(each.predictions for each in some)),
            sum(each.hints for each in some),
            float(median(each.minutes for each in some)),
        )
        for name, some in by_lesson.items()
    )
    heads = (
        Column("lesson", Style.TEXT),
        Column("began"),
        Column("steps", decimals=1),
        Column("attempts"),
        Column("points"),
        Column("predicted"),
        Column("hints"),
        Column("minutes", decimals=1),
    )
    note = "steps, minutes: the median student's. points: of those that were tried for. predicted: rightly."
    return Table("lessons", "By lesson", heads, rows, note)


def _by_exercise(by_lesson: dict[str, list[LessonWork]]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for lesson, some in by_lesson.items():
        for name in dict.fromkeys(key for each in some for key in each.exercises):
            done = [each.exercises[name] for each in some if name in each.exercises]
            tried = [each for each in done if each.attempts]
            passing = [each.tries_to_pass for each in tried if each.tries_to_pass is not None]
            rows.append(
                (
                    f"{lesson}/{name}",
                    len(tried),
                    len(passing),
                    float(median(passing)) if passing else None,
                    _share(sum(each.points for each in tried), sum(each.max_points for each in tried)),
                    sum(each.solution for each in done),
                    _lost(tried),
                )
            )
    heads = (
        Column("exercise", Style.TEXT),
        Column("tried"),
        Column("passed"),
        Column("at try", decimals=1),
        Column("points"),
        Column("solution"),
        Column("lost most", Style.TEXT),
    )
    note = (
        "at try: the median of who passed. solution: opened. lost most: criteria, and by how many students "
        "they were lost at least once."
    )
    return Table("exercises", "By exercise", heads, tuple(rows), note)


def _lost(tried: list[ExerciseWork]) -> str:
    counts: dict[str, int] = {}
    for each in tried:
        for criterion in each.lost:
            counts[criterion] = counts.get(criterion, 0) + 1
    most = sorted(counts.items(), key=lambda pair: (-pair[1], pair[0]))[:MOST_LOST]
    return ", ".join(f"{name} {count}" for name, count in most)


def _by_student(setting: Setting) -> Table:
    data = setting.data
    counts = {outcome: data.quiz.count(outcome) for outcome in Outcome} if data.quiz.items else {}
    rows: list[tuple[Cell, ...]] = []
    for i, name in enumerate(data.names):
        work = data.work[i].values()
        taken = bool(counts) and not np.isnan(counts[Outcome.RIGHT][i])
        rows.append(
            (
                name,
                len(work),
                sum(each.passed for each in work),
                sum(each.attempts for each in work),
                float(sum(each.points for each in work)),
                sum(each.hints for each in work),
                float(sum(each.minutes for each in work)),
                "/".join(f"{counts[outcome][i]:.0f}" for outcome in Outcome) if taken else None,
            )
        )
    heads = (
        Column("student", Style.TEXT),
        Column("lessons"),
        Column("passed"),
        Column("attempts"),
        Column("points", decimals=1),
        Column("hints"),
        Column("minutes", decimals=0),
        Column("quiz"),
    )
    note = "quiz: right/wrong/not sure/blank. passed: exercises."
    return Table("students", "By student", heads, tuple(rows), note)


def _share(part: float, whole: float) -> float | None:
    return part / whole if whole else None


def words(setting: Setting) -> Chapter | None:
    """What they wrote, question by question, unchanged."""
    blocks: list[Block] = []
    asked = ""
    for each in setting.data.remarks:
        if each.question.id != asked:
            asked = each.question.id
            blocks.append(Text(each.question.text))
        blocks.append(Said(each.who, each.text))
    return Chapter("words", "In their own words", tuple(blocks)) if blocks else None
