"""Answering a form: what counts, what comes next, what a line means."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from kit.school.form_answers import (
    FormAnswers,
    InvalidAnswer,
    asked_questions,
    is_asked,
    open_questions,
    parse_answer,
)
from kit.school.form_reading import FORM_FILE, read_form
from kit.school.lessons.reading import lessons_folder
from kit.school.progress import EventKind, ProgressEvent
from kit.school.survey import (
    AnswerShape,
    AskCondition,
    QuestionPurpose,
    SurveyForm,
    SurveyPhase,
    SurveyQuestion,
)
from kit.world.problems import WorldError
from tests.cases import every_case

RATED = SurveyQuestion(
    "rated",
    "How much?",
    QuestionPurpose.EXPERIENCE,
    phases=(SurveyPhase.BEFORE, SurveyPhase.AFTER),
    low="a",
    high="b",
)
DONE = SurveyQuestion("done", "Did you?", QuestionPurpose.DONE, AnswerShape.YES_NO)
WHY = SurveyQuestion(
    "why", "Why?", QuestionPurpose.WORDS, AnswerShape.TEXT, only_if=AskCondition("done", answer=True)
)
MORE = SurveyQuestion(
    "more", "More?", QuestionPurpose.WORDS, AnswerShape.TEXT, only_if=AskCondition("rated", at_least=3)
)
CHOSEN = SurveyQuestion(
    "chosen", "Which?", QuestionPurpose.BACKGROUND, AnswerShape.CHOICE, options=("left", "right")
)
FORM = SurveyForm("A form", (RATED, DONE, WHY, MORE, CHOSEN))


def said(question: str, value: Any, phase: str = "after", number: int = 0) -> ProgressEvent:
    at = f"2026-01-01T00:00:{number:02}+00:00"
    return ProgressEvent(
        f"{question}{phase}{number}", at, EventKind.FORM, question, {"phase": phase, "value": value}
    )


def open_after(*events: ProgressEvent) -> list[str]:
    return [
        each.id for each in open_questions(FORM, FormAnswers.from_events(FORM, events), SurveyPhase.AFTER)
    ]


def questions_for(form: SurveyForm, purpose: QuestionPurpose) -> list[SurveyQuestion]:
    return [each for each in form.questions if each.purpose is purpose]


def test_a_blank_is_an_answer_and_stays_blank() -> None:
    answers = FormAnswers.from_events(FORM, [said("rated", None)])
    assert answers.is_answered("rated", SurveyPhase.AFTER)
    assert answers.value("rated", SurveyPhase.AFTER) is None
    assert not answers.is_answered("rated", SurveyPhase.BEFORE)
    assert open_after(said("rated", None)) == ["done", "chosen"]


def test_rules_follow_the_answers() -> None:
    assert open_after() == ["rated", "done", "chosen"]
    assert "why" in open_after(said("done", True))
    assert "why" not in open_after(said("done", False))
    assert "why" not in open_after(said("done", None))
    assert "more" in open_after(said("rated", 3))
    assert "more" not in open_after(said("rated", 2))
    assert "more" in open_after(said("rated", 5, "before")), (
        "a rule looks at the other time where this one is open"
    )
    assert "more" not in open_after(said("rated", 5, "before"), said("rated", 1))


def test_the_last_answer_counts() -> None:
    answers = FormAnswers.from_events(FORM, [said("rated", 2, number=1), said("rated", 6, number=2)])
    assert answers.value("rated", SurveyPhase.AFTER) == 6


@every_case("value", [0, 8, -1, 3.5, "3", True, [3], {"a": 1}, 10**30])
def test_what_cannot_be_an_answer_is_left_out_and_named(value: Any) -> None:
    answers = FormAnswers.from_events(FORM, [said("rated", value)])
    assert not answers.values
    assert answers.invalid_questions == ("rated",)


@every_case(
    ("question", "value"), [("done", 1), ("chosen", "up"), ("why", 5), ("why", False), ("chosen", True)]
)
def test_each_shape_has_answers_of_its_own(question: str, value: Any) -> None:
    assert FormAnswers.from_events(FORM, [said(question, value)]).invalid_questions == (question,)


@every_case("phase", ["before", "later", None, ["after"], {}])
def test_a_phase_in_which_it_is_not_asked_does_not_count(phase: Any) -> None:
    event = ProgressEvent(
        "u", "2026-01-01T00:00:00+00:00", EventKind.FORM, "done", {"phase": phase, "value": True}
    )
    assert not FormAnswers.from_events(FORM, [event]).values


def test_unknown_questions_and_other_events_are_passed_over() -> None:
    other = ProgressEvent("u", "2026-01-01T00:00:00+00:00", EventKind.STEP, "rated", {})
    answers = FormAnswers.from_events(FORM, [said("of a newer kit", 3), other])
    assert answers == FormAnswers()


@every_case(
    ("question", "line", "value"),
    [
        (RATED, "7\n", 7),
        (RATED, " 1 ", 1),
        (RATED, "\n", None),
        (DONE, "Y", True),
        (DONE, "no", False),
        (CHOSEN, "2", "right"),
        (WHY, " because \n", "because"),
        (WHY, "", None),
    ],
)
def test_a_line_is_understood(question: SurveyQuestion, line: str, value: Any) -> None:
    assert parse_answer(question, line) == value
    assert question.can_be_answered_with(parse_answer(question, line))


@every_case(
    ("question", "line"),
    [
        (RATED, "8"),
        (RATED, "0"),
        (RATED, "x"),
        (RATED, "3.5"),
        (RATED, "٣"),
        (RATED, "9" * 5000),
        (DONE, "perhaps"),
        (CHOSEN, "3"),
        (CHOSEN, "left"),
        (WHY, "a" * 5000),
        (WHY, "\x1b[A"),
        (WHY, "\udcff"),
    ],
)
def test_a_line_that_is_no_answer_says_what_would_be(question: SurveyQuestion, line: str) -> None:
    with pytest.raises(InvalidAnswer) as caught:
        parse_answer(question, line)
    assert str(caught.value)


def test_every_question_of_the_kits_form_can_be_reached() -> None:
    """Whoever says yes to everything, and knows much, is asked everything."""
    form = read_form()
    yes = {AnswerShape.SCALE: 7, AnswerShape.YES_NO: True, AnswerShape.TEXT: "words"}
    events = []
    for phase in SurveyPhase:
        events += [
            said(each.id, yes.get(each.shape, each.options[:1] and each.options[0]), phase.value)
            for each in form.questions_in_phase(phase)
        ]
        answers = FormAnswers.from_events(form, events)
        assert not answers.invalid_questions
        assert asked_questions(form, answers, phase) == list(form.questions_in_phase(phase))
        assert not open_questions(form, answers, phase)
        assert all(is_asked(each, answers, phase) for each in form.questions_in_phase(phase))


GROUP = """
title: A form
groups:
  - id: one
    purpose: done
    shape: yes_no
    text: Is it so?
"""


def test_the_kits_form_asks_what_the_report_needs() -> None:
    form = read_form()
    assert {each.topic for each in questions_for(form, QuestionPurpose.EXPERIENCE)} >= {
        "robotics",
        "ros1",
        "ros2",
        "simulators",
        "flatland",
        "rl",
    }
    for purpose in QuestionPurpose:
        assert questions_for(form, purpose), purpose
    rated = [each for each in form.questions if each.shape is AnswerShape.SCALE]
    assert all(each.low and each.high for each in rated)
    assert all(each.topic for each in rated if each.purpose is not QuestionPurpose.SETUP)
    hard, told = (
        questions_for(form, QuestionPurpose.DIFFICULTY),
        questions_for(form, QuestionPurpose.EXPLANATION),
    )
    assert {each.topic for each in hard} == {each.topic for each in told}


def test_experience_is_asked_twice_the_same_way() -> None:
    both = {each.phases for each in questions_for(read_form(), QuestionPurpose.EXPERIENCE)}
    assert both == {(SurveyPhase.BEFORE, SurveyPhase.AFTER)}


def test_what_stands_in_the_file_fits_a_screen() -> None:
    assert max(map(len, (lessons_folder() / FORM_FILE).read_text().splitlines())) <= 120
    assert all(len(each.text) <= 100 for each in read_form().questions)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (GROUP + "    colour: red\n", ('unknown key "colour"', ":8:")),
        (GROUP.replace("yes_no", "yesno"), ('did you mean "yes_no"',)),
        (GROUP.replace("purpose: done", "purpose: outcomes"), ('did you mean "outcome"',)),
        (GROUP + "  - {id: one, purpose: done, shape: yes_no, text: Again}\n", ("there twice", ":8:")),
        (GROUP + "    phases: [afterwards]\n", ('did you mean "after"',)),
        (GROUP + "    only_if: {question: none, answer: true}\n", ('no earlier question is called "none"',)),
        (
            GROUP
            + "  - {id: two, purpose: done, shape: yes_no, text: B, only_if: {question: one, at_least: 3}}\n",
            ("yes_no",),
        ),
        (GROUP + "  - {id: two, purpose: gained, text: B}\n", ('"low" is missing', '"high" is missing')),
        (GROUP + "  - {id: two, purpose: done, shape: choice, text: B}\n", ('"options" is missing',)),
        ("title: Nothing\n", ('"groups" is missing',)),
        ("- a list\n", ("mapping",)),
    ],
    ids=[
        "unknown-key",
        "shape",
        "purpose",
        "twice",
        "phase",
        "rule-of-nothing",
        "rule-of-another-shape",
        "scale-without-ends",
        "choice-without-options",
        "no-groups",
        "list",
    ],
)
def test_a_mistake_is_reported_with_its_location(tmp_path: Path, text: str, words: tuple[str, ...]) -> None:
    file = tmp_path / "form.yaml"
    file.write_text(text)
    with pytest.raises(WorldError) as caught:
        read_form(file)
    assert all(word in str(caught.value) for word in (*words, str(file)))
