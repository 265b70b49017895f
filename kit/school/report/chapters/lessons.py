"""Chapters on work in the lessons, by lesson, exercise and student; and on free-text answers."""

from __future__ import annotations

from statistics import median
from typing import Final

import numpy as np

from kit.school.quiz.schedule import AnswerOutcome
from kit.school.report.chapters.context import ReportContext
from kit.school.report.document import (
    CellStyle,
    Quote,
    ReportBlock,
    ReportChapter,
    ReportTable,
    ReportText,
    TableCell,
    TableColumn,
)
from kit.school.report.students import MAX_IDLE, ExerciseWork, LessonWork, started_lessons

MAX_NAMED_CRITERIA: Final = 2
"""Largest number of lost criteria named for an exercise."""


def lessons_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter on attempts, points and time."""
    work = context.data.work
    names = started_lessons(work)
    if not names:
        return None
    by_lesson = {name: [each[name] for each in work if name in each] for name in names}
    tables = (_lesson_table(by_lesson), _exercise_table(by_lesson), _student_table(context))
    blocks: list[ReportBlock] = [table for table in tables if table.rows]
    minutes = int(MAX_IDLE.total_seconds() // 60)
    blocks.append(
        ReportText(
            f"Time is what lies between two entries of a lesson; more than {minutes} minutes without one count as a "
            "pause. Points are the best attempt's. Attempts whose check broke are not counted."
        )
    )
    return ReportChapter("lessons", "Lessons", tuple(blocks))


def _lesson_table(by_lesson: dict[str, list[LessonWork]]) -> ReportTable:
    rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            name,
            len(some),
            float(median(len(each.steps) for each in some)),
            sum(each.attempt_count for each in some),
            _ratio(sum(each.points for each in some), sum(each.max_points for each in some)),
            _ratio(sum(each.predicted_right for each in some), sum(each.predictions for each in some)),
            sum(each.hint_count for each in some),
            float(median(each.minutes for each in some)),
        )
        for name, some in by_lesson.items()
    )
    heads = (
        TableColumn("lesson", CellStyle.TEXT),
        TableColumn("began"),
        TableColumn("steps", decimals=1),
        TableColumn("attempts"),
        TableColumn("points"),
        TableColumn("predicted"),
        TableColumn("hints"),
        TableColumn("minutes", decimals=1),
    )
    note = "steps, minutes: the median student's. points: of those that were tried for. predicted: rightly."
    return ReportTable("lessons", "By lesson", heads, rows, note)


def _exercise_table(by_lesson: dict[str, list[LessonWork]]) -> ReportTable:
    rows: list[tuple[TableCell, ...]] = []
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
                    _ratio(sum(each.points for each in tried), sum(each.max_points for each in tried)),
                    sum(each.has_seen_solution for each in done),
                    _most_lost(tried),
                )
            )
    heads = (
        TableColumn("exercise", CellStyle.TEXT),
        TableColumn("tried"),
        TableColumn("passed"),
        TableColumn("at try", decimals=1),
        TableColumn("points"),
        TableColumn("solution"),
        TableColumn("lost most", CellStyle.TEXT),
    )
    note = (
        "at try: the median of who passed. solution: opened. lost most: criteria, and by how many students "
        "they were lost at least once."
    )
    return ReportTable("exercises", "By exercise", heads, tuple(rows), note)


def _most_lost(tried: list[ExerciseWork]) -> str:
    counts: dict[str, int] = {}
    for each in tried:
        for criterion in each.lost_criteria:
            counts[criterion] = counts.get(criterion, 0) + 1
    most = sorted(counts.items(), key=lambda pair: (-pair[1], pair[0]))[:MAX_NAMED_CRITERIA]
    return ", ".join(f"{name} {count}" for name, count in most)


def _student_table(context: ReportContext) -> ReportTable:
    data = context.data
    counts = (
        {outcome: data.quiz.outcome_counts(outcome) for outcome in AnswerOutcome} if data.quiz.items else {}
    )
    rows: list[tuple[TableCell, ...]] = []
    for i, name in enumerate(data.names):
        work = data.work[i].values()
        taken = bool(counts) and not np.isnan(counts[AnswerOutcome.RIGHT][i])
        rows.append(
            (
                name,
                len(work),
                sum(each.passed_count for each in work),
                f"{sum(each.defended_count for each in work)}/{sum(each.defence_count for each in work)}",
                sum(each.attempt_count for each in work),
                float(sum(each.points for each in work)),
                sum(each.hint_count for each in work),
                float(sum(each.minutes for each in work)),
                "/".join(f"{counts[outcome][i]:.0f}" for outcome in AnswerOutcome) if taken else None,
            )
        )
    heads = (
        TableColumn("student", CellStyle.TEXT),
        TableColumn("lessons"),
        TableColumn("passed"),
        TableColumn("defended"),
        TableColumn("attempts"),
        TableColumn("points", decimals=1),
        TableColumn("hints"),
        TableColumn("minutes", decimals=0),
        TableColumn("quiz"),
    )
    note = (
        "quiz: right/wrong/not sure/blank. passed: exercises. defended: of which every question about the own program "
        "was right at once, and how often it was asked."
    )
    return ReportTable("students", "By student", heads, tuple(rows), note)


def _ratio(part: float, whole: float) -> float | None:
    return part / whole if whole else None


def free_text_chapter(context: ReportContext) -> ReportChapter | None:
    """The chapter of free-text answers, question by question, unchanged."""
    blocks: list[ReportBlock] = []
    question_id = ""
    for each in context.data.free_text_answers:
        if each.question.id != question_id:
            question_id = each.question.id
            blocks.append(ReportText(each.question.text))
        blocks.append(Quote(each.student, each.text))
    return ReportChapter("words", "In their own words", tuple(blocks)) if blocks else None
