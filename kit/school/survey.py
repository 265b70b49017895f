"""The evaluation form: its questions, as ``lessons/form.yaml`` has them, and a student's answers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Final, TypeGuard

from kit.plain_text import is_printable, quoted, suggestion
from kit.school.lessons.reading import lessons_folder
from kit.school.lessons.translation import translated_words, translation_of
from kit.school.progress import EventKind, ProgressEvent
from kit.world.documents import open_document
from kit.world.yaml_section import Section

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

    def questions_for(self, purpose: QuestionPurpose) -> tuple[SurveyQuestion, ...]:
        return tuple(each for each in self.questions if each.purpose is purpose)

    def questions_in_phase(self, phase: SurveyPhase) -> Iterator[SurveyQuestion]:
        return (each for each in self.questions if phase in each.phases)


FORM_FILE: Final = "form.yaml"

_SHAPES: Final = {each.value: each for each in AnswerShape}
_PURPOSES: Final = {each.value: each for each in QuestionPurpose}
_PHASES: Final = {each.value: each for each in SurveyPhase}


def read_form(file: Path | None = None) -> SurveyForm:
    """Reads the form in a file, by default the kit's. Raises WorldError with all its mistakes, and FileNotFoundError."""
    file = lessons_folder() / FORM_FILE if file is None else file
    questions: list[SurveyQuestion] = []
    with open_document(file) as section:
        title = section.name("title")
        for group in section.sections("groups", at_least=1):
            _add_group(questions, group)
    translation = translation_of(file)
    form = SurveyForm(title, tuple(questions))
    return form if translation is None else _translated_form(form, translation)


def _translated_form(form: SurveyForm, file: Path) -> SurveyForm:
    """The same form in the words of a translation. The options of a choice stay: an answer is kept as one of them."""
    with open_document(file) as section:
        words = translated_words(section)

    def said(text: str) -> str:
        return words.get(" ".join(text.split()), text)

    questions = [
        replace(
            each,
            text=said(each.text),
            group_text=said(each.group_text),
            low=said(each.low),
            high=said(each.high),
            shown_options=tuple(said(option) for option in each.options),
        )
        for each in form.questions
    ]
    return SurveyForm(said(form.title), tuple(questions))


def _add_group(questions: list[SurveyQuestion], group: Section) -> None:
    for question, section in _read_questions(group):
        if any(each.id == question.id for each in questions):
            section.error(f"{quoted(question.id)} is there twice", "id")
        rule = question.only_if
        if rule is not None:
            _check_condition(rule, questions, group)
        questions.append(question)
    group.finish()


def _read_questions(group: Section) -> Iterator[tuple[SurveyQuestion, Section]]:
    """Yields the questions of a group, each with the section that holds its id."""
    identity = group.name("id")
    shape = group.choice("shape", _SHAPES, AnswerShape.SCALE.value)
    text = group.name("text")
    question = SurveyQuestion(
        id=identity,
        text=text,
        purpose=group.choice("purpose", _PURPOSES) or QuestionPurpose.WORDS,
        shape=shape,
        topic=group.name("topic") if group.has("topic") else "",
        phases=tuple(_PHASES[name] for name in _read_phase_names(group)),
        low=group.name("low") if shape is AnswerShape.SCALE else "",
        high=group.name("high") if shape is AnswerShape.SCALE else "",
        options=group.texts("options", at_least=2) if shape is AnswerShape.CHOICE else (),
        only_if=_read_condition(group.section("only_if", None)),
    )
    if not group.has("rows"):
        yield question, group
        return
    for row in group.sections("rows", at_least=1):
        yield (
            SurveyQuestion(
                id=f"{identity}.{row.name('id')}",
                text=row.name("text"),
                purpose=question.purpose,
                shape=shape,
                group_text=text,
                topic=row.name("topic") if row.has("topic") else question.topic,
                phases=question.phases,
                low=question.low,
                high=question.high,
                options=question.options,
                only_if=question.only_if,
            ),
            row,
        )
        row.finish()


def _read_phase_names(group: Section) -> tuple[str, ...]:
    names = group.texts("phases", (SurveyPhase.AFTER.value,), at_least=1)
    wrong = [name for name in names if name not in _PHASES]
    for name in wrong:
        group.error(f"there is no phase {quoted(name)}: {suggestion(name, _PHASES)}", "phases")
    return tuple(name for name in names if name not in wrong)


def _read_condition(section: Section | None) -> AskCondition | None:
    if section is None:
        return None
    question = section.name("question")
    condition = (
        AskCondition(question, at_least=section.integer("at_least", minimum=SCALE_MIN, maximum=SCALE_MAX))
        if section.has("at_least")
        else AskCondition(question, answer=section.flag("answer"))
    )
    section.finish()
    return condition


def _check_condition(rule: AskCondition, earlier: list[SurveyQuestion], group: Section) -> None:
    """Reports a condition on a later question, or on an answer that the question cannot have."""
    named = next((each for each in earlier if each.id == rule.question), None)
    if named is None:
        hint = suggestion(rule.question, [each.id for each in earlier])
        group.error(f"no earlier question is called {quoted(rule.question)}: {hint}", "only_if")
        return
    shape = AnswerShape.YES_NO if rule.at_least is None else AnswerShape.SCALE
    if named.shape is not shape:
        group.error(
            f"{quoted(rule.question)} is of shape {named.shape.value}: `answer` goes with yes_no, `at_least` with scale",
            "only_if",
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
