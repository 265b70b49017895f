"""Counts of answers by outcome and topic, and how well confidence agrees with them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from kit.school.quiz.answers import CONFIDENCE_LABELS, AnswerOutcome, QuizAnswer
from kit.school.quiz.items import (
    OPTION_COUNT,
    QuizItem,
    QuizTopic,
)

EXPECTED_SHARES: Final[Mapping[int, float]] = {1: 1 / OPTION_COUNT, 2: 0.5, 3: 0.75, 4: 0.95}
"""Confidence -> share of right answers that it claims; a guess among three options is right one time in three."""

MIN_ANSWERS: Final = 8
"""Answers with a confidence below which calibration is not reported."""

CALIBRATED_GAP: Final = 0.1
"""Largest difference of expected and actual share that counts as calibrated."""


@dataclass(frozen=True, slots=True)
class OutcomeCounts:
    """Number of items by outcome."""

    right: int = 0
    wrong: int = 0
    not_sure: int = 0
    blank: int = 0
    not_asked: int = 0

    @property
    def total(self) -> int:
        return self.right + self.wrong + self.not_sure + self.blank + self.not_asked


@dataclass(frozen=True, slots=True)
class ConfidenceLevel:
    """The answers given with one confidence level."""

    confidence: int
    answers: int
    right: int


@dataclass(frozen=True, slots=True)
class Calibration:
    """Confidence against the share of right answers."""

    levels: tuple[ConfidenceLevel, ...]
    """From the least to the most sure; unused levels have no answers."""

    @property
    def answers(self) -> int:
        return sum(level.answers for level in self.levels)

    @property
    def expected_share(self) -> float:
        """The share of right answers that the confidences claim; 0 without answers."""
        claims = sum(EXPECTED_SHARES[level.confidence] * level.answers for level in self.levels)
        return claims / self.answers if self.answers else 0.0

    @property
    def actual_share(self) -> float:
        """The share of right answers; 0 without answers."""
        return sum(level.right for level in self.levels) / self.answers if self.answers else 0.0


def latest_answers(answers: Iterable[QuizAnswer]) -> dict[str, QuizAnswer]:
    """Item id -> last answer to it."""
    return {answer.item: answer for answer in answers}


def count_outcomes(items: Iterable[QuizItem], by_item: Mapping[str, QuizAnswer]) -> OutcomeCounts:
    """Counts items by outcome."""
    counts = Counter(by_item[item.id].outcome if item.id in by_item else None for item in items)
    return OutcomeCounts(
        counts[AnswerOutcome.RIGHT],
        counts[AnswerOutcome.WRONG],
        counts[AnswerOutcome.NOT_SURE],
        counts[AnswerOutcome.BLANK],
        counts[None],
    )


def count_by_topic(
    items: Iterable[QuizItem], by_item: Mapping[str, QuizAnswer]
) -> dict[QuizTopic, OutcomeCounts]:
    """Counts items by outcome for each topic that has any."""
    of_topic: dict[QuizTopic, list[QuizItem]] = {}
    for item in items:
        of_topic.setdefault(item.topic, []).append(item)
    return {topic: count_outcomes(of_topic[topic], by_item) for topic in QuizTopic if topic in of_topic}


def measure_calibration(answers: Iterable[QuizAnswer]) -> Calibration:
    """Measures calibration over all answers with a confidence."""
    counts: Counter[int] = Counter()
    right: Counter[int] = Counter()
    for answer in answers:
        if answer.confidence is not None:
            counts[answer.confidence] += 1
            right[answer.confidence] += answer.outcome is AnswerOutcome.RIGHT
    return Calibration(tuple(ConfidenceLevel(each, counts[each], right[each]) for each in CONFIDENCE_LABELS))
