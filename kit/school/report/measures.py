"""A class's ratings and quiz replies as arrays by student."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from kit.arrays import BoolArray, FloatArray
from kit.school.quiz.answers import AnswerOutcome
from kit.school.report.inference import non_blank
from kit.school.survey import QuestionPurpose, SurveyPhase, SurveyQuestion


@dataclass(frozen=True, slots=True)
class ItemReply:
    """One student's answer to one item. Only RIGHT counts as right; wrong, not sure and blank are kept apart."""

    outcome: AnswerOutcome
    chosen: int | None = None
    """Index of the chosen option, from 0."""


BLANK = ItemReply(AnswerOutcome.BLANK)


@dataclass(frozen=True, slots=True)
class ReportItem:
    """A question of the quiz."""

    id: str
    topic: str
    options: tuple[str, ...] = ()
    """Texts of the options, where they are known."""
    in_quiz: bool = False
    """Whether the quiz asks it; else only lessons and practice do."""


@dataclass(frozen=True, slots=True)
class AnswerSheet:
    """Items with each student's reply."""

    items: tuple[ReportItem, ...]
    replies: Mapping[str, tuple[ItemReply | None, ...]]
    """Item id -> replies in the order of the students; None: the student did not take the quiz."""

    def correctness(self, item: ReportItem) -> FloatArray:
        """(n,) 1 for right, 0 for anything else, NaN for students who did not take the quiz."""
        return np.array(
            [
                np.nan if each is None else float(each.outcome is AnswerOutcome.RIGHT)
                for each in self.replies[item.id]
            ]
        )

    def share_right(self, items: Sequence[ReportItem]) -> FloatArray:
        """(n,) share of these items answered rightly."""
        return row_means([self.correctness(item) for item in items])

    @property
    def scores(self) -> FloatArray:
        """(n,) share of all items answered rightly."""
        return self.share_right(self.items)

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics in the order of the items."""
        return tuple(dict.fromkeys(item.topic for item in self.items))

    def topic_items(self, topic: str) -> tuple[ReportItem, ...]:
        return tuple(item for item in self.items if item.topic == topic)

    def without_replies(self) -> AnswerSheet:
        """A copy with the same items and no replies."""
        return AnswerSheet(self.items, {name: (None,) * len(row) for name, row in self.replies.items()})

    def outcome_counts(self, outcome: AnswerOutcome) -> FloatArray:
        """(n,) number of items with that outcome."""
        replies = [self.replies[item.id] for item in self.items]
        return np.array(
            [
                np.nan
                if any(row[i] is None for row in replies)
                else sum(_has_outcome(row[i], outcome) for row in replies)
                for i in range(len(replies[0]) if replies else 0)
            ],
            dtype=np.float64,
        )


def _has_outcome(reply: ItemReply | None, outcome: AnswerOutcome) -> bool:
    return reply is not None and reply.outcome is outcome


@dataclass(frozen=True, slots=True, eq=False)
class StudentMeasure:
    """One quantity of each student."""

    id: str
    label: str
    values: FloatArray
    """(n,), NaN where blank."""


@dataclass(frozen=True, slots=True)
class ClassRatings:
    """A class's answers on scales."""

    questions: tuple[SurveyQuestion, ...]
    values: Mapping[tuple[SurveyPhase, str], FloatArray]
    """(phase, question id) -> (n,) ratings 1 to 7, NaN where blank."""

    def measures(self, purpose: QuestionPurpose, phase: SurveyPhase) -> tuple[StudentMeasure, ...]:
        """One measure for each question with any answer in that phase."""
        return tuple(
            StudentMeasure(each.id, each.text, values)
            for each in self.questions
            if each.purpose is purpose
            and (values := self.values.get((phase, each.id))) is not None
            and len(non_blank(values))
        )

    def topic_means(self, purpose: QuestionPurpose, phase: SurveyPhase) -> tuple[StudentMeasure, ...]:
        """One measure per topic: each student's mean over its questions."""
        topics: dict[str, list[FloatArray]] = {}
        for measure in self.measures(purpose, phase):
            topics.setdefault(self._measure_topic(measure), []).append(measure.values)
        return tuple(StudentMeasure(topic, topic, row_means(rows)) for topic, rows in topics.items())

    def topic_measures(
        self, purpose: QuestionPurpose, phase: SurveyPhase, topic: str
    ) -> tuple[StudentMeasure, ...]:
        return tuple(each for each in self.measures(purpose, phase) if self._measure_topic(each) == topic)

    def topics(self, purpose: QuestionPurpose, phase: SurveyPhase) -> tuple[str, ...]:
        return tuple(dict.fromkeys(self._measure_topic(each) for each in self.measures(purpose, phase)))

    def overall_means(self, purpose: QuestionPurpose, phase: SurveyPhase) -> FloatArray | None:
        """Each student's mean over the topics' means, so that a topic of many questions counts no more than
        another; None without any answer."""
        topics = self.topic_means(purpose, phase)
        return row_means([each.values for each in topics]) if topics else None

    def _measure_topic(self, measure: StudentMeasure) -> str:
        return next(each.topic for each in self.questions if each.id == measure.id)


def row_means(rows: Iterable[FloatArray]) -> FloatArray:
    """(n,) each student's mean over the rows, without NaN; NaN where all are NaN."""
    table = np.stack(list(rows))
    there = ~np.isnan(table)
    count = there.sum(axis=0)
    total = np.where(there, table, 0.0).sum(axis=0)
    return np.asarray(np.where(count > 0, total / np.maximum(count, 1), np.nan), dtype=np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class StudentGroup:
    """A group of students."""

    name: str
    members: BoolArray
    """(n,)"""
