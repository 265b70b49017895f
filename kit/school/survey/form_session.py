"""Answering a form: what was said, what comes next, and what a typed line means. Nothing here asks or stores."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

from kit.plain_text import is_printable
from kit.school.progress import EventKind, ProgressEvent
from kit.school.survey.questions import HIGHEST, LOWEST, Form, Phase, Question, Shape, Value

LONGEST_TEXT: Final = 4000
"""Characters of one free answer."""

_YES: Final[Mapping[str, bool]] = {"y": True, "yes": True, "n": False, "no": False}


class NotAnAnswer(ValueError):
    """A line that does not answer the question; the message says what would."""


@dataclass(frozen=True, slots=True)
class Answers:
    """What one student said so far; of several answers to one question the last one counts."""

    given: Mapping[tuple[Phase, str], Value] = field(default_factory=dict)
    """By phase and question. A blank is there as None; what was never asked is not there."""
    odd: tuple[str, ...] = ()
    """Questions whose stored answer cannot be one, which are left out."""

    @classmethod
    def of(cls, form: Form, events: Iterable[ProgressEvent]) -> Answers:
        """Folds a student's events; those about questions that the form does not have are passed over."""
        given: dict[tuple[Phase, str], Value] = {}
        odd: dict[str, None] = {}
        for event in events:
            question = form.find(event.subject) if event.kind is EventKind.FORM else None
            if question is None:
                continue
            phase, value = event.content.get("phase"), event.content.get("value")
            if phase in question.phases and question.accepts(value):
                given[Phase(phase), question.id] = value
            else:
                odd[question.id] = None
        return cls(given, tuple(odd))

    def value(self, question: str, phase: Phase) -> Value:
        return self.given.get((phase, question))

    def latest(self, question: str, phase: Phase) -> Value:
        """What was said in this phase; else in the last other one in which it was."""
        where = (phase, *(each for each in reversed(Phase) if each is not phase))
        return next((self.value(question, each) for each in where if self.has(question, each)), None)

    def has(self, question: str, phase: Phase) -> bool:
        """Whether it was answered or left blank on purpose."""
        return (phase, question) in self.given

    def started(self, phase: Phase) -> bool:
        return any(of is phase for of, _ in self.given)


def applies(question: Question, answers: Answers, phase: Phase) -> bool:
    """Whether the question is asked of this student."""
    rule = question.only_if
    return phase in question.phases and (rule is None or rule.allows(answers.latest(rule.question, phase)))


def asked(form: Form, answers: Answers, phase: Phase) -> list[Question]:
    """All questions of the phase that this student is asked, as things stand."""
    return [each for each in form.in_phase(phase) if applies(each, answers, phase)]


def still_open(form: Form, answers: Answers, phase: Phase) -> list[Question]:
    """Those of them that were neither answered nor left blank yet."""
    return [each for each in asked(form, answers, phase) if not answers.has(each.id, phase)]


def parse(question: Question, line: str) -> Value:
    """What a typed line answers; an empty one leaves the question blank. Raises NotAnAnswer."""
    text = line.strip()
    return _PARSERS[question.shape](question, text) if text else None


def _scale(question: Question, text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 3 and LOWEST <= int(text) <= HIGHEST):
        raise NotAnAnswer(f"Type a number from {LOWEST} to {HIGHEST}, or nothing to leave it blank.")
    return int(text)


def _choice(question: Question, text: str) -> str:
    count = len(question.options)
    if not (text.isascii() and text.isdigit() and len(text) <= 3 and 1 <= int(text) <= count):
        raise NotAnAnswer(f"Type a number from 1 to {count}, or nothing to leave it blank.")
    return question.options[int(text) - 1]


def _yes_no(question: Question, text: str) -> bool:
    if text.lower() not in _YES:
        raise NotAnAnswer("Type y or n, or nothing to leave it blank.")
    return _YES[text.lower()]


def _text(question: Question, text: str) -> str:
    if len(text) > LONGEST_TEXT:
        raise NotAnAnswer(f"That is {len(text)} characters; {LONGEST_TEXT} fit. Say it in fewer.")
    if "\ufffd" in text or not is_printable(text):
        raise NotAnAnswer("Some of that was no text, such as a key's code. Type it again.")
    return text


_PARSERS: Final[Mapping[Shape, Callable[[Question, str], Value]]] = {
    Shape.SCALE: _scale,
    Shape.CHOICE: _choice,
    Shape.YES_NO: _yes_no,
    Shape.TEXT: _text,
}
