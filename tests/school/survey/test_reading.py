"""The form's file: the kit's own is whole, and each mistake in another is told at its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.survey.reading import AnswerShape, QuestionPurpose, SurveyPhase, form_file, read_form
from kit.world.problems import WorldError

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
    assert {each.topic for each in form.questions_for(QuestionPurpose.EXPERIENCE)} >= {
        "robotics",
        "ros1",
        "ros2",
        "simulators",
        "flatland",
        "rl",
    }
    for purpose in QuestionPurpose:
        assert form.questions_for(purpose), purpose
    rated = [each for each in form.questions if each.shape is AnswerShape.SCALE]
    assert all(each.low and each.high for each in rated)
    assert all(each.topic for each in rated if each.purpose is not QuestionPurpose.SETUP)
    hard, told = (
        form.questions_for(QuestionPurpose.DIFFICULTY),
        form.questions_for(QuestionPurpose.EXPLANATION),
    )
    assert {each.topic for each in hard} == {each.topic for each in told}


def test_experience_is_asked_twice_the_same_way() -> None:
    both = {each.phases for each in read_form().questions_for(QuestionPurpose.EXPERIENCE)}
    assert both == {(SurveyPhase.BEFORE, SurveyPhase.AFTER)}


def test_what_stands_in_the_file_fits_a_screen() -> None:
    assert max(map(len, form_file().read_text().splitlines())) <= 120
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
