"""An answer to a question of the quiz, and how the journal keeps it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime
from enum import Enum, StrEnum
from typing import Any, Final

from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.items import OPTION_COUNT, QuizItem


class AnswerOccasion(StrEnum):
    """The occasion on which a question was asked."""

    QUIZ = "quiz"
    LESSON = "lesson"
    SPACED = "spaced"


class AnswerOutcome(Enum):
    """The outcome of an answer. Blank, not sure and wrong are kept apart, since they call for different help."""

    RIGHT = "right"
    WRONG = "wrong"
    NOT_SURE = "not sure"
    BLANK = "blank"


@dataclass(frozen=True, slots=True)
class AnswerChoice:
    """The chosen option, from 0; or None, with or without "not sure"."""

    option: int | None
    not_sure: bool = False

    def outcome_for(self, item: QuizItem) -> AnswerOutcome:
        if self.option is None:
            return AnswerOutcome.NOT_SURE if self.not_sure else AnswerOutcome.BLANK
        return AnswerOutcome.RIGHT if self.option == item.right_option else AnswerOutcome.WRONG


NOT_SURE: Final = AnswerChoice(None, not_sure=True)
BLANK: Final = AnswerChoice(None)

CONFIDENCE_LABELS: Final[Mapping[int, str]] = {
    1: "a guess",
    2: "rather unsure",
    3: "fairly sure",
    4: "certain",
}
"""Labels of the confidence levels, the answers to "how sure are you?"."""


@dataclass(frozen=True, slots=True)
class QuizAnswer:
    """One answer, read from the journal."""

    item: str
    time: datetime
    outcome: AnswerOutcome
    confidence: int | None
    occasion: AnswerOccasion


def event_content(
    item: QuizItem, choice: AnswerChoice, confidence: int | None, occasion: AnswerOccasion
) -> dict[str, Any]:
    """The content of an answer's event. Without a chosen option no confidence is kept."""
    return {
        "chosen": choice.option,
        "not_sure": choice.not_sure,
        "right": choice.outcome_for(item) is AnswerOutcome.RIGHT,
        "confidence": None if choice.option is None else confidence,
        "occasion": occasion.value,
        "topic": item.topic.value,
    }


def answer_from_event(event: ProgressEvent) -> QuizAnswer | None:
    """The answer in an event; None for another kind of event, or malformed content."""
    if event.kind is not EventKind.ANSWER:
        return None
    content = event.content
    chosen, confidence = content.get("chosen"), content.get("confidence")
    try:
        occasion = AnswerOccasion(str(content.get("occasion")))
    except ValueError:
        return None
    if chosen is None:
        outcome = AnswerOutcome.NOT_SURE if content.get("not_sure") is True else AnswerOutcome.BLANK
    elif chosen in range(OPTION_COUNT):
        outcome = AnswerOutcome.RIGHT if content.get("right") is True else AnswerOutcome.WRONG
    else:
        return None
    return QuizAnswer(
        event.subject,
        event.time,
        outcome,
        confidence if isinstance(confidence, int) and confidence in CONFIDENCE_LABELS else None,
        occasion,
    )


def answers_from_events(events: Iterable[ProgressEvent]) -> list[QuizAnswer]:
    """The answers in the events, without malformed ones, in the order of the events."""
    return [answer for event in events if (answer := answer_from_event(event)) is not None]
