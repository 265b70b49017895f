"""Every printed table of the evaluation from its raw answers, and what differs from the print."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.school.report.chapters.context import ReportContext
from kit.school.report.class_data import ClassData
from kit.school.report.class_report import prepare_report
from kit.school.report.expertise import DIVISION_METHODS
from kit.school.report.inference import summary_statistics
from kit.school.report.measures import (
    AnswerSheet,
    StudentMeasure,
)
from kit.school.survey import QuestionPurpose, SurveyPhase
from kit.study.evaluation_data import EvaluationData

TableRows = dict[str, tuple[float, ...]]
"""The numbers of a table by the labels of its rows."""

ROUNDING_TOLERANCE: Final = 0.005 + 1e-9
"""A number printed with two decimals lies no farther from what was computed."""


@dataclass(frozen=True, slots=True)
class PrintDifference:
    """A printed number that the raw answers do not give."""

    table: str
    row: str
    column: str
    printed: float
    ours: float


def setting_of(study: EvaluationData) -> ReportContext:
    """The dissertation's subjects as a class, divided at the mean score."""
    names = tuple(f"subject {number}" for number in range(1, study.subjects + 1))
    data = ClassData(
        names,
        study.ratings,
        study.quiz,
        later_quiz=study.quiz.without_replies(),
        bank=AnswerSheet((), {}),
        work=tuple({} for _ in names),
        free_text_answers=(),
        option_counts=(),
        warnings=(),
    )
    return prepare_report(data)


@lru_cache(maxsize=1)
def recompute_tables(study: EvaluationData) -> Mapping[str, TableRows]:
    """Every printed table from the raw answers, by its number."""
    context = setting_of(study)
    return {printed.id: _TABLES[printed.id](context) for printed in study.printed}


def differences_from_print(study: EvaluationData) -> tuple[PrintDifference, ...]:
    """All numbers that differ by more than rounding, known slips and others."""
    ours = recompute_tables(study)
    return tuple(
        PrintDifference(table.id, row, column, printed, computed)
        for table in study.printed
        for row, numbers in table.rows.items()
        for column, printed, computed in zip(table.columns, numbers, ours[table.id][row], strict=True)
        if abs(printed - computed) > ROUNDING_TOLERANCE
    )


def unexplained_differences(study: EvaluationData) -> tuple[PrintDifference, ...]:
    """Differences that are not known misprints, or are known with another value."""
    known = {
        (slip.table, cell.row, cell.column): cell.ours for slip in study.misprints for cell in slip.cells
    }
    return tuple(
        each
        for each in differences_from_print(study)
        if abs(known.get((each.table, each.row, each.column), np.inf) - each.ours) > ROUNDING_TOLERANCE
    )


def score_order(context: ReportContext) -> list[int]:
    """The subjects, from 0, in the order of Table 5.4: the highest score first."""
    assert context.score is not None  # everybody rated the six topics
    return [int(i) for i in np.argsort(-context.score, kind="stable")]


def _score_table(context: ReportContext) -> TableRows:
    """Table 5.4. An expert is 1, a beginner 0."""
    assert context.score is not None
    found = {each.id: each.experts.members for each in context.divisions}
    return {
        str(place): (float(context.score[i]), *(float(found[way][i]) for way in DIVISION_METHODS))
        for place, i in enumerate(score_order(context), 1)
    }


def _division_table(context: ReportContext) -> TableRows:
    """Table 5.5."""
    assert context.score is not None
    names = {"scale": "at 3.5", "half": "in half", "mean": "at M"}
    grid: TableRows = {}
    for each in context.divisions:
        numbers: list[float] = []
        for group in each.groups:
            stats = summary_statistics(context.score[group.members])
            numbers += [stats.n, stats.mean, stats.sd]
        grid[names[each.id]] = tuple(numbers)
    return grid


def _mean_and_sd_rows(context: ReportContext, measures: Sequence[FloatArray]) -> TableRows:
    """M and SD of each group, a column for each measure."""
    grid: TableRows = {}
    for group in context.groups:
        found = [summary_statistics(values[group.members]) for values in measures]
        grid[f"{group.name} M"] = tuple(each.mean for each in found)
        grid[f"{group.name} SD"] = tuple(each.sd for each in found)
    return grid


def _outcome_table(topic: str) -> Callable[[ReportContext], TableRows]:
    """Tables 5.6 and 5.7."""

    def table(context: ReportContext) -> TableRows:
        measures = context.data.ratings.topic_measures(QuestionPurpose.OUTCOME, SurveyPhase.AFTER, topic)
        return _mean_and_sd_rows(context, [each.values for each in measures])

    return table


def _question_table(context: ReportContext) -> TableRows:
    """Table 5.8."""
    quiz = context.data.quiz
    return {
        item.id: tuple(float(quiz.correctness(item)[group.members].mean()) for group in context.groups)
        for item in quiz.items
    }


def _quiz_topic_table(context: ReportContext) -> TableRows:
    """Table 5.9."""
    quiz = context.data.quiz
    return _mean_and_sd_rows(
        context, [*(quiz.share_right(quiz.topic_items(topic)) for topic in quiz.topics), quiz.scores]
    )


def _text_table(context: ReportContext) -> TableRows:
    """The numbers of the running text of 5.3.1 to 5.3.4."""
    ratings = context.data.ratings
    prior = _values_by_id(ratings.topic_means(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE))
    gained = _values_by_id(ratings.topic_means(QuestionPurpose.GAINED, SurveyPhase.AFTER))
    hard = _values_by_id(ratings.topic_means(QuestionPurpose.DIFFICULTY, SurveyPhase.AFTER))
    explained = _values_by_id(ratings.topic_means(QuestionPurpose.EXPLANATION, SurveyPhase.AFTER))
    of = {"prior": _mean_over_topics(prior), "gained": _mean_over_topics(gained)}
    of |= {"difficulty": _mean_over_topics(hard), "explanation": _mean_over_topics(explained)}
    assert context.score is not None
    rows: dict[str, FloatArray] = {
        "prior, Robotics": prior["robotics"],
        "prior, ROS 1": prior["ros1"],
        "prior, ROS 2": prior["ros2"],
        "prior, all six": of["prior"],
        "expertise score": context.score,
        "difficulty, RL": hard["rl"],
        "difficulty, ROS 2": hard["ros2"],
        "explanation, ROS 2": explained["ros2"],
    }
    for what, group in ((w, g) for w in ("gained", "difficulty", "explanation") for g in context.groups):
        rows[f"{what}, {group.name}"] = of[what][group.members]
    return {
        name: (stats.mean, stats.sd)
        for name, values in rows.items()
        for stats in [summary_statistics(values)]
    }


def _values_by_id(measures: Sequence[StudentMeasure]) -> dict[str, FloatArray]:
    return {each.id: each.values for each in measures}


def _mean_over_topics(measures: Mapping[str, FloatArray]) -> FloatArray:
    """Each subject's mean over topics; nobody left one of these blank."""
    mean: FloatArray = np.stack(list(measures.values())).mean(axis=0)
    return mean


_TABLES: Final[Mapping[str, Callable[[ReportContext], TableRows]]] = {
    "5.4": _score_table,
    "5.5": _division_table,
    "5.6": _outcome_table("teleop"),
    "5.7": _outcome_table("rl"),
    "5.8": _question_table,
    "5.9": _quiz_topic_table,
    "text": _text_table,
}
