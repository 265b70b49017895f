"""The raw answers and printed tables of the dissertation's evaluation as records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.plain_text import quoted
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.measures import (
    BLANK,
    AnswerSheet,
    ClassRatings,
    ItemReply,
    ReportItem,
)
from kit.school.survey import SCALE_MAX, SCALE_MIN, QuestionPurpose, SurveyPhase, SurveyQuestion
from kit.study.printed_tables import Misprint, PrintedTable, read_misprint, read_printed_table
from kit.world.documents import open_document
from kit.world.yaml_section import Section

DATA_FILE: Final = Path(__file__).with_name("evaluation.yaml")

BLANK_ANSWER: Final = "-"

_TOPIC_TITLES: Final[Mapping[str, str]] = {"ros2": "ROS 2", "flatland": "Flatland", "rl": "RL"}
_PURPOSES: Final = {each.value: each for each in QuestionPurpose}


@dataclass(frozen=True, slots=True, eq=False)
class EvaluationData:
    """All that is known of the evaluation."""

    subjects: int
    ratings: ClassRatings
    quiz: AnswerSheet
    printed: tuple[PrintedTable, ...]
    misprints: tuple[Misprint, ...]


def read_evaluation_data(file: Path = DATA_FILE) -> EvaluationData:
    """Raises WorldError with all mistakes of the file."""
    with open_document(file) as section:
        subjects = section.integer("subjects", minimum=2)
        printed = tuple(read_printed_table(each) for each in section.sections("printed"))
        return EvaluationData(
            subjects,
            _read_ratings(section.sections("ratings", at_least=1), subjects),
            _read_quiz(section.sections("quiz", at_least=1), subjects),
            printed,
            tuple(read_misprint(each, printed) for each in section.sections("slips")),
        )


def _read_ratings(sections: tuple[Section, ...], subjects: int) -> ClassRatings:
    questions: list[SurveyQuestion] = []
    values: dict[tuple[SurveyPhase, str], FloatArray] = {}
    for section in sections:
        purpose = section.choice("purpose", _PURPOSES) or QuestionPurpose.WORDS
        if not section.flag("counted", True):
            purpose = QuestionPurpose.BACKGROUND
        phase = SurveyPhase.BEFORE if purpose is QuestionPurpose.EXPERIENCE else SurveyPhase.AFTER
        made = SurveyQuestion(
            f"q{section.integer('n', minimum=1)}",
            section.name("text"),
            purpose,
            topic=section.name("topic"),
            phases=(phase,),
        )
        questions.append(made)
        answers = _read_answers(section, subjects, SCALE_MAX)
        values[phase, made.id] = np.array([np.nan if each is None else float(each) for each in answers])
        section.finish()
    return ClassRatings(tuple(questions), values)


def _read_quiz(sections: tuple[Section, ...], subjects: int) -> AnswerSheet:
    items: list[ReportItem] = []
    replies: dict[str, tuple[ItemReply | None, ...]] = {}
    for section in sections:
        topic = section.name("topic")
        item = ReportItem(f"{_TOPIC_TITLES.get(topic, topic)} {section.name('question')}", topic)
        keys = {int(word) for word in section.name("keys").split() if word.isdigit()}
        items.append(item)
        replies[item.id] = tuple(
            BLANK
            if each is None
            else ItemReply(AnswerOutcome.RIGHT if each in keys else AnswerOutcome.WRONG, each - 1)
            for each in _read_answers(section, subjects, 4)
        )
        section.finish()
    return AnswerSheet(tuple(items), replies)


def _read_answers(section: Section, subjects: int, highest: int) -> list[int | None]:
    """One for each subject; None for a blank."""
    words = section.name("answers").split()
    right = [word == BLANK_ANSWER or (word.isdigit() and SCALE_MIN <= int(word) <= highest) for word in words]
    if len(words) != subjects or not all(right):
        section.error(
            f'"answers" must be {subjects} numbers from {SCALE_MIN} to {highest}, or {quoted(BLANK_ANSWER)}',
            "answers",
        )
        return [None] * subjects
    return [None if word == BLANK_ANSWER else int(word) for word in words]
