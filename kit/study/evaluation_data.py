"""``evaluation.yaml`` becomes records: the raw answers of appendix B.3, the printed tables, their known slips."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from kit.kernels.arrays import Float64Array
from kit.plain_text import quoted
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.measures import BLANK, AnswerSheet, ClassRatings, ItemReply, ReportItem
from kit.school.survey.questions import SCALE_MAX, SCALE_MIN, QuestionPurpose, SurveyPhase, SurveyQuestion
from kit.world.documents import WorldDocuments
from kit.world.files import AllowedRoot
from kit.world.problems import ProblemCollector
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section

DATA_FILE: Final = Path(__file__).with_name("evaluation.yaml")

BLANK_ANSWER: Final = "-"

_TOPIC_TITLES: Final[Mapping[str, str]] = {"ros2": "ROS 2", "flatland": "Flatland", "rl": "RL"}
_GROUP_LETTERS: Final[Mapping[str, float]] = {"B": 0.0, "E": 1.0}
_PURPOSES: Final = {each.value: each for each in QuestionPurpose}


@dataclass(frozen=True, slots=True)
class PrintedTable:
    """A table as the dissertation prints it."""

    id: str
    title: str
    columns: tuple[str, ...]
    rows: Mapping[str, tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class MisprintCell:
    """One printed number that is wrong."""

    row: str
    column: str
    ours: float
    """The value from the raw answers, to two decimals."""


@dataclass(frozen=True, slots=True)
class Misprint:
    """Printed numbers that are wrong for one reason."""

    table: str
    why: str
    cells: tuple[MisprintCell, ...]


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
    problems = ProblemCollector()
    section = WorldDocuments(AllowedRoot.containing(file), {}, problems).section(file, SourceLocation(file))
    problems.raise_if_any()
    assert section is not None  # None is noted as a problem
    subjects = section.integer("subjects", minimum=2)
    study = EvaluationData(
        subjects,
        _read_ratings(section.sections("ratings", at_least=1), subjects),
        _read_quiz(section.sections("quiz", at_least=1), subjects),
        tuple(_read_printed_table(each) for each in section.sections("printed")),
        tuple(_read_misprint(each) for each in section.sections("slips")),
    )
    section.finish()
    problems.raise_if_any()
    return study


def _read_ratings(sections: tuple[Section, ...], subjects: int) -> ClassRatings:
    questions: list[SurveyQuestion] = []
    values: dict[tuple[SurveyPhase, str], Float64Array] = {}
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


def _read_printed_table(section: Section) -> PrintedTable:
    columns = section.texts("columns", at_least=1)
    rows: dict[str, tuple[float, ...]] = {}
    for row in section.texts("rows", at_least=1):
        label, _, rest = row.partition("|")
        try:
            numbers = tuple(
                _GROUP_LETTERS[word] if word in _GROUP_LETTERS else float(word) for word in rest.split()
            )
        except ValueError:
            numbers = ()
        if len(numbers) != len(columns):
            section.error(f"{quoted(row)} must be LABEL | {len(columns)} numbers", "rows")
        rows[label.strip()] = numbers
    made = PrintedTable(section.name("id"), section.name("title"), columns, rows)
    section.finish()
    return made


def _read_misprint(section: Section) -> Misprint:
    cells = []
    for each in section.sections("cells", at_least=1):
        cells.append(MisprintCell(each.name("row"), each.name("column"), each.number("ours")))
        each.finish()
    made = Misprint(section.name("table"), section.name("why"), tuple(cells))
    section.finish()
    return made
