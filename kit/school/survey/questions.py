"""A form as data: questions on scales, with choices, yes or no, or in the student's own words, and when each is asked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Final, TypeGuard

LOWEST: Final = 1
HIGHEST: Final = 7
"""Of every scale."""

Value = int | str | bool | None
"""What was answered: a point of the scale, a text or an option, yes or no; None: left blank."""


class Shape(StrEnum):
    """How a question is answered."""

    SCALE = "scale"
    CHOICE = "choice"
    YES_NO = "yes_no"
    TEXT = "text"


class Phase(StrEnum):
    """When a question is asked."""

    BEFORE = "before"
    """The lessons."""
    AFTER = "after"
    """The lessons."""
    QUIZZED = "quizzed"
    """After the quiz, which shows what one knows: what one says of oneself is asked once more."""


class Purpose(StrEnum):
    """What a question is for; the class report makes a table of each kind of rating."""

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
class Rule:
    """A question is asked only where an earlier one was answered so."""

    question: str
    answer: bool | None = None
    """This answer to a question of yes or no."""
    at_least: int | None = None
    """At least so much on a scale."""

    def allows(self, value: Value) -> bool:
        """A blank never does."""
        if self.at_least is not None:
            return isinstance(value, int) and not isinstance(value, bool) and value >= self.at_least
        return isinstance(value, bool) and value is self.answer


@dataclass(frozen=True, slots=True)
class Question:
    """One question, or one row of a group of them."""

    id: str
    text: str
    """Of the row; of the question itself where there are no rows."""
    purpose: Purpose
    shape: Shape = Shape.SCALE
    lead: str = ""
    """What is asked of every row of the group; empty where there are no rows."""
    topic: str = ""
    """Such as ``ros2``; ratings are averaged by it. Those of experience name what Algorithm 4 asks for."""
    phases: tuple[Phase, ...] = (Phase.AFTER,)
    low: str = ""
    """What the scale's lowest point means."""
    high: str = ""
    options: tuple[str, ...] = ()
    only_if: Rule | None = None

    def accepts(self, value: object) -> TypeGuard[Value]:
        """Whether a stored value can be an answer to this question; a blank can."""
        if value is None:
            return True
        if isinstance(value, bool):
            return self.shape is Shape.YES_NO
        if isinstance(value, int):
            return self.shape is Shape.SCALE and LOWEST <= value <= HIGHEST
        if isinstance(value, str):
            return value in self.options if self.shape is Shape.CHOICE else self.shape is Shape.TEXT
        return False


@dataclass(frozen=True, slots=True)
class Form:
    """All questions, in the order in which they are asked."""

    title: str
    questions: tuple[Question, ...]

    def find(self, identity: str) -> Question | None:
        return next((each for each in self.questions if each.id == identity), None)

    def of(self, purpose: Purpose) -> tuple[Question, ...]:
        return tuple(each for each in self.questions if each.purpose is purpose)

    def in_phase(self, phase: Phase) -> Iterator[Question]:
        return (each for each in self.questions if phase in each.phases)
