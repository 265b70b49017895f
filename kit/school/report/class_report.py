"""The class report: all chapters in order, from a class's numbers."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from kit.school.report.chapters import lessons, people, quiz, ratings, relations
from kit.school.report.chapters.setting import Setting
from kit.school.report.class_data import ClassData
from kit.school.report.document import Chapter, Report
from kit.school.report.expertise import WAYS, divide, scores
from kit.school.survey.questions import Phase, Purpose

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


def set_up(data: ClassData, *, way: str = "mean", seed: int = 0) -> Setting:
    """The class with its scores and groups. ``way``: one of ``WAYS``."""
    score = scores(data.ratings.measures(Purpose.EXPERIENCE, Phase.BEFORE), topics_of(data))
    divisions = tuple(
        division for each in WAYS if score is not None and (division := divide(score, each)) is not None
    )
    chosen = next((each for each in divisions if each.id == way), None)
    return Setting(data, score, divisions, chosen, seed)


def chapters(setting: Setting, wanted: Collection[str] = ()) -> tuple[Chapter, ...]:
    """Those that there are numbers for, of ``wanted`` ones or all; without the one about files."""
    made = (make(setting) for make in _MAKERS)
    return tuple(each for each in made if each is not None and (not wanted or each.id in wanted))


def class_report(setting: Setting, files: int, wanted: Collection[str] = ()) -> Report:
    """The whole report of a class that was read from ``files`` files."""
    first = people.people(setting, files)
    head = (first,) if not wanted or first.id in wanted else ()
    return Report("Class report", (*head, *chapters(setting, wanted)))


def topics_of(data: ClassData) -> dict[str, str]:
    """Which topic each question is about."""
    return {each.id: each.topic for each in data.ratings.questions}
