"""Builds the class report: all chapters in order, from the data of a class."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from kit.document.blocks import Chapter, Document
from kit.school.report.chapters import people, quiz, relations
from kit.school.report.chapters.context import ReportContext
from kit.school.report.class_data import ClassData
from kit.school.report.expertise import DIVISION_METHODS, divide_class, expertise_scores
from kit.school.survey import QuestionPurpose, SurveyPhase

_CHAPTER_BUILDERS: Final = (
    people.experience_chapter,
    people.knowledge_chapter,
    people.outcomes_chapter,
    people.difficulty_chapter,
    people.topic_clarity_chapter,
    quiz.quiz_chapter,
    quiz.items_chapter,
    relations.relations_chapter,
    relations.robustness_chapter,
    quiz.lessons_chapter,
    quiz.free_text_chapter,
)

CHAPTER_IDS: Final = (
    "class",
    "experience",
    "knowledge",
    "outcomes",
    "difficulty",
    "explanation",
    "quiz",
    "items",
    "relations",
    "robustness",
    "lessons",
    "words",
)
"""Ids of the chapters, in order."""


def prepare_report(data: ClassData, *, method: str = "mean", seed: int = 0) -> ReportContext:
    """Computes scores and groups of a class. ``method``: one of ``DIVISION_METHODS``."""
    score = expertise_scores(
        data.ratings.measures(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE), question_topics(data)
    )
    divisions = tuple(
        division
        for each in DIVISION_METHODS
        if score is not None and (division := divide_class(score, each)) is not None
    )
    chosen = next((each for each in divisions if each.id == method), None)
    return ReportContext(data, score, divisions, chosen, seed)


def build_chapters(context: ReportContext, chapter_ids: Collection[str] = ()) -> tuple[Chapter, ...]:
    """Builds the chapters that there is data for, all or those with the ids given; without the one about files."""
    chapters = (make(context) for make in _CHAPTER_BUILDERS)
    return tuple(
        each for each in chapters if each is not None and (not chapter_ids or each.id in chapter_ids)
    )


def build_report(context: ReportContext, file_count: int, chapter_ids: Collection[str] = ()) -> Document:
    """Builds the whole report of a class that was read from ``file_count`` files."""
    first = people.class_chapter(context, file_count)
    head = (first,) if not chapter_ids or first.id in chapter_ids else ()
    return Document("Class report", (*head, *build_chapters(context, chapter_ids)))


def question_topics(data: ClassData) -> dict[str, str]:
    """Question id -> topic."""
    return {each.id: each.topic for each in data.ratings.questions}
