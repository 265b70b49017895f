"""A student's answers to the evaluation form: which questions are asked, and how an answer is read."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

from kit.plain_text import is_printable
from kit.school.progress import EventKind, ProgressEvent
from kit.school.survey import (
    SCALE_MAX,
    SCALE_MIN,
    AnswerShape,
    AnswerValue,
    SurveyForm,
    SurveyPhase,
    SurveyQuestion,
)

MAX_TEXT_LENGTH: Final = 4000
"""Characters of one free answer."""
_YES: Final[Mapping[str, bool]] = {"y": True, "yes": True, "n": False, "no": False}


class InvalidAnswer(ValueError):
    """A line that does not answer the question; the message says which lines do."""


@dataclass(frozen=True, slots=True)
class FormAnswers:
    """One student's answers so far; of several answers to one question the last one counts."""

    values: Mapping[tuple[SurveyPhase, str], AnswerValue] = field(default_factory=dict)
    """(phase, question id) -> value; None: left blank. Questions that were never asked have no entry."""
    invalid_questions: tuple[str, ...] = ()
    """Ids of questions with a stored value that cannot be an answer; those are left out."""

    @classmethod
    def from_events(cls, form: SurveyForm, events: Iterable[ProgressEvent]) -> FormAnswers:
        """Reads the answers in a student's events; skips questions that the form does not have."""
        values: dict[tuple[SurveyPhase, str], AnswerValue] = {}
        invalid: dict[str, None] = {}
        for event in events:
            question = form.find_question(event.subject) if event.kind is EventKind.FORM else None
            if question is None:
                continue
            phase, value = event.content.get("phase"), event.content.get("value")
            if phase in question.phases and question.can_be_answered_with(value):
                values[SurveyPhase(phase), question.id] = value
            else:
                invalid[question.id] = None
        return cls(values, tuple(invalid))

    def value(self, question: str, phase: SurveyPhase) -> AnswerValue:
        return self.values.get((phase, question))

    def latest_value(self, question: str, phase: SurveyPhase) -> AnswerValue:
        """The answer of this phase; else that of the latest other phase in which there is one."""
        where = (phase, *(each for each in reversed(SurveyPhase) if each is not phase))
        return next((self.value(question, each) for each in where if self.is_answered(question, each)), None)

    def is_answered(self, question: str, phase: SurveyPhase) -> bool:
        """Whether the question was answered or left blank on purpose."""
        return (phase, question) in self.values

    def has_started(self, phase: SurveyPhase) -> bool:
        return any(of is phase for of, _ in self.values)


def is_asked(question: SurveyQuestion, answers: FormAnswers, phase: SurveyPhase) -> bool:
    """Whether this student is asked the question in this phase."""
    rule = question.only_if
    return phase in question.phases and (
        rule is None or rule.is_met(answers.latest_value(rule.question, phase))
    )


def asked_questions(form: SurveyForm, answers: FormAnswers, phase: SurveyPhase) -> list[SurveyQuestion]:
    """All questions of the phase that this student is asked, given the answers so far."""
    return [each for each in form.questions_in_phase(phase) if is_asked(each, answers, phase)]


def open_questions(form: SurveyForm, answers: FormAnswers, phase: SurveyPhase) -> list[SurveyQuestion]:
    """The asked questions that were neither answered nor left blank yet."""
    return [each for each in asked_questions(form, answers, phase) if not answers.is_answered(each.id, phase)]


def parse_answer(question: SurveyQuestion, line: str) -> AnswerValue:
    """Parses a typed line; an empty one leaves the question blank. Raises InvalidAnswer."""
    text = line.strip()
    return _PARSERS[question.shape](question, text) if text else None


def _parse_scale(question: SurveyQuestion, text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 3 and SCALE_MIN <= int(text) <= SCALE_MAX):
        raise InvalidAnswer(f"Type a number from {SCALE_MIN} to {SCALE_MAX}, or nothing to leave it blank.")
    return int(text)


def _parse_choice(question: SurveyQuestion, text: str) -> str:
    count = len(question.options)
    if not (text.isascii() and text.isdigit() and len(text) <= 3 and 1 <= int(text) <= count):
        raise InvalidAnswer(f"Type a number from 1 to {count}, or nothing to leave it blank.")
    return question.options[int(text) - 1]


def _parse_yes_no(question: SurveyQuestion, text: str) -> bool:
    if text.lower() not in _YES:
        raise InvalidAnswer("Type y or n, or nothing to leave it blank.")
    return _YES[text.lower()]


def _parse_text(question: SurveyQuestion, text: str) -> str:
    if len(text) > MAX_TEXT_LENGTH:
        raise InvalidAnswer(f"That is {len(text)} characters; at most {MAX_TEXT_LENGTH} fit. Shorten it.")
    if "\ufffd" in text or not is_printable(text):
        raise InvalidAnswer("Some characters are not text, such as the code of a key. Type the answer again.")
    return text


_PARSERS: Final[Mapping[AnswerShape, Callable[[SurveyQuestion, str], AnswerValue]]] = {
    AnswerShape.SCALE: _parse_scale,
    AnswerShape.CHOICE: _parse_choice,
    AnswerShape.YES_NO: _parse_yes_no,
    AnswerShape.TEXT: _parse_text,
}
