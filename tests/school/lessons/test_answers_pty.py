"""Each question whose answer is looked up, measured or computed is answered from its page, as a student would do it in a
terminal of 80x24; the grader takes what the page leads to for right."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path

import pytest
import yaml

from grader.grading import GradingOptions, grade
from grader.kinds.answers.kind import AnswerQuestion
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.checking import read_solution, submission_path
from kit.school.lessons.reading import lesson_names
from kit.school.lessons.records import Exercise
from tests.cases import every_case
from tests.kit_content import kit_lesson
from tests.pasted_commands import Home
from tests.school.lessons.answer_derivations import DERIVATIONS, UNDERSTOOD, ExercisePage

PLACES = {
    f"{name}/{step.exercise.name}": (kit_lesson(name), step, step.exercise)
    for name in lesson_names()
    for step in kit_lesson(name).steps
    if step.exercise is not None and read_assignment(step.exercise.folder).kind == "answers"
}


def test_each_exercise_has_a_derivation_or_asks_for_understanding_alone() -> None:
    assert {*DERIVATIONS, *UNDERSTOOD} == set(PLACES)
    asking = {name for name in PLACES if set(questions_of(name)) - set(UNDERSTOOD.get(name, ()))}
    assert asking == set(DERIVATIONS)


@every_case("name", UNDERSTOOD)
def test_a_question_of_understanding_offers_choices_and_names_no_command(name: str) -> None:
    """A number or a word of one's own comes from somewhere: it is looked up, measured or computed."""
    questions = questions_of(name)
    assert set(UNDERSTOOD[name]) <= set(questions)
    understood = [questions[each] for each in UNDERSTOOD[name]]
    assert [each.name for each in understood if not each.choices or "kit " in each.ask] == []


@pytest.mark.long_cases(
    "01-drive/readout",
    "03-services-and-parameters/which",
    "32-command-line-and-bags/evidence",
    "32-command-line-and-bags/live",
    "35-photo-to-map/sheet",
)
@pytest.mark.parametrize("name", DERIVATIONS)
def test_what_a_page_leads_to_is_right(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lesson, step, exercise = PLACES[name]
    page = ExercisePage(Home(tmp_path / "home", monkeypatch), lesson, step)
    answers = DERIVATIONS[name](page)
    understood = UNDERSTOOD.get(name, ())
    assert set(answers) == set(page.questions) - set(understood)
    solution = yaml.load(read_solution(lesson, exercise)[exercise.file], yaml.BaseLoader)
    given = {each: solution[each] for each in understood}
    refused = set()
    for ways in zip_longest(*answers.values()):
        given |= {each: way for each, way in zip(answers, ways, strict=True) if way is not None}
        page.file.write_text("".join(f"{each}: {way}\n" for each, way in given.items()))
        refused |= _refused(exercise, page.file)
    assert refused == set()


def questions_of(name: str) -> dict[str, AnswerQuestion]:
    return {each.name: each for each in read_assignment(PLACES[name][2].folder).task.questions}


def _refused(exercise: Exercise, file: Path) -> set[str]:
    """What the grader says of answers that it takes for wrong."""
    assignment = read_assignment(exercise.folder)
    submission = read_submission(submission_path(exercise, file), assignment.submit)
    result = grade(assignment, submission, GradingOptions(Level.LIMITED, secret=True))
    return {f"{each.id}: {each.rationale}" for each in result.tests if not each.is_passed}
