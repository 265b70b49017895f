"""The evaluation form: its questions, in which phase they are asked, and of whom."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Final, TypeGuard

SCALE_MIN: Final = 1

SCALE_MAX: Final = 7
"""Bounds of every scale."""

AnswerValue = int | str | bool | None
"""An answer: a point of the scale, a text or an option, yes or no; None: left blank."""


class AnswerShape(StrEnum):
    """The kind of answer that a question takes."""

    SCALE = "scale"
    CHOICE = "choice"
    YES_NO = "yes_no"
    TEXT = "text"


class SurveyPhase(StrEnum):
    """When a question is asked, relative to the lessons and the quiz."""

    BEFORE = "before"
    """Before the lessons."""
    AFTER = "after"
    """After the lessons."""
    QUIZZED = "quizzed"
    """After the quiz, which shows students what they know: they rate themselves once more."""


class QuestionPurpose(StrEnum):
    """The purpose of a question; the class report makes a table of each kind of rating."""

    BACKGROUND = "background"
    EXPERIENCE = "experience"
    GAINED = "gained"
    OUTCOME = "outcome"
    DIFFICULTY = "difficulty"
    EXPLANATION = "explanation"
    SETUP = "setup"
    DONE = "done"
    WORDS = "words"


@dataclass(frozen=True, slots=True)
class AskCondition:
    """A condition on the answer to an earlier question."""

    question: str
    answer: bool | None = None
    """The required answer to a yes-or-no question."""
    at_least: int | None = None
    """The lowest required point on a scale."""

    def is_met(self, value: AnswerValue) -> bool:
        """Whether the value meets the condition; a blank never does."""
        if self.at_least is not None:
            return isinstance(value, int) and not isinstance(value, bool) and value >= self.at_least
        return isinstance(value, bool) and value is self.answer


@dataclass(frozen=True, slots=True)
class SurveyQuestion:
    """One question, or one row of a group of them."""

    id: str
    text: str
    """Text of the row; of the question itself where there are no rows."""
    purpose: QuestionPurpose
    shape: AnswerShape = AnswerShape.SCALE
    group_text: str = ""
    """Question text shared by all rows of the group; empty where there are no rows."""
    topic: str = ""
    """Topic by which ratings are averaged, such as ``ros2``. Algorithm 4 reads those of experience by it."""
    phases: tuple[SurveyPhase, ...] = (SurveyPhase.AFTER,)
    low: str = ""
    """Meaning of the scale's lowest point."""
    high: str = ""
    options: tuple[str, ...] = ()
    """Options of a choice; an answer is stored as one of them."""
    shown_options: tuple[str, ...] = ()
    """The same options in another language; empty where they are shown as they are kept."""
    only_if: AskCondition | None = None

    @property
    def values(self) -> tuple[AnswerValue, ...]:
        """The answers to choose from, in order; empty for a text."""
        match self.shape:
            case AnswerShape.SCALE:
                return tuple(range(SCALE_MIN, SCALE_MAX + 1))
            case AnswerShape.YES_NO:
                return (True, False)
            case _:
                return self.options

    def can_be_answered_with(self, value: object) -> TypeGuard[AnswerValue]:
        """Whether a stored value can be an answer to this question, a blank included."""
        if value is None:
            return True
        if isinstance(value, bool):
            return self.shape is AnswerShape.YES_NO
        if isinstance(value, int):
            return self.shape is AnswerShape.SCALE and SCALE_MIN <= value <= SCALE_MAX
        if isinstance(value, str):
            return (
                value in self.options if self.shape is AnswerShape.CHOICE else self.shape is AnswerShape.TEXT
            )
        return False


@dataclass(frozen=True, slots=True)
class SurveyForm:
    """All questions, in the order in which they are asked."""

    title: str
    questions: tuple[SurveyQuestion, ...]

    def find_question(self, identity: str) -> SurveyQuestion | None:
        return next((each for each in self.questions if each.id == identity), None)

    def questions_in_phase(self, phase: SurveyPhase) -> Iterator[SurveyQuestion]:
        return (each for each in self.questions if phase in each.phases)
