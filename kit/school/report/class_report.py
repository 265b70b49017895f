"""The class report: all chapters in order, from a class's numbers."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from kit.school.report.chapters import lessons, people, quiz, ratings, relations
from kit.school.report.chapters.setting import Setting
from kit.school.report.class_data import ClassData
from kit.school.report.document import ClassReport, ReportChapter
from kit.school.report.expertise import DIVISION_METHODS, divide_class, expertise_scores
from kit.school.survey.questions import QuestionPurpose, SurveyPhase

_MAKERS: Final = (
    people.experience,
    ratings.knowledge,
    ratings.outcomes,
    ratings.difficulty,
    ratings.explanation,
    quiz.quiz,
    quiz.items,
    relations.relations,
    relations.robustness,
    lessons.lessons,
    lessons.words,
)

CHAPTERS: Final = (
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
"""The chapters' ids, in order."""


def prepare_report(data: ClassData, *, method: str = "mean", seed: int = 0) -> Setting:
    """The class with its scores and groups. ``way``: one of ``WAYS``."""
    score = expertise_scores(
        data.ratings.measures(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE), question_topics(data)
    )
    divisions = tuple(
        division
        for each in DIVISION_METHODS
        if score is not None and (division := divide_class(score, each)) is not None
    )
    chosen = next((each for each in divisions if each.id == method), None)
    return Setting(data, score, divisions, chosen, seed)


def build_chapters(setting: Setting, wanted: Collection[str] = ()) -> tuple[ReportChapter, ...]:
    """Those that there are numbers for, of ``wanted`` ones or all; without the one about files."""
    made = (make(setting) for make in _MAKERS)
    return tuple(each for each in made if each is not None and (not wanted or each.id in wanted))


def build_report(setting: Setting, files: int, wanted: Collection[str] = ()) -> ClassReport:
    """The whole report of a class that was read from ``files`` files."""
    first = people.people(setting, files)
    head = (first,) if not wanted or first.id in wanted else ()
    return ClassReport("Class report", (*head, *build_chapters(setting, wanted)))


def question_topics(data: ClassData) -> dict[str, str]:
    """Which topic each question is about."""
    return {each.id: each.topic for each in data.ratings.questions}
