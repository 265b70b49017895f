"""Reads the evaluation form from ``lessons/form.yaml``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

from kit.plain_text import quoted, suggestion
from kit.school.lessons.reading import lessons_folder
from kit.school.lessons.translation import translated_words, translation_of
from kit.school.survey import (
    SCALE_MAX,
    SCALE_MIN,
    AnswerShape,
    AskCondition,
    QuestionPurpose,
    SurveyForm,
    SurveyPhase,
    SurveyQuestion,
)
from kit.world.documents import open_document
from kit.world.yaml_section import Section

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
    """The form in the words of a translation. The options of a choice stay: an answer is kept as one of them."""
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
