"""A session with the evaluation form: what is asked next, what going back comes to, and what is kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.school.form_answers import FormAnswers
from kit.school.form_reading import read_form
from kit.school.form_session import FormSession, current_phase
from kit.school.progress import EventKind, ProgressJournal
from kit.school.survey import AnswerShape, SurveyPhase

FORM = read_form()
BEFORE = [each.id for each in FORM.questions_in_phase(SurveyPhase.BEFORE)]


@pytest.fixture
def journal(tmp_path: Path) -> Iterator[ProgressJournal]:
    with ProgressJournal(tmp_path) as opened:
        yield opened


def answer_all(session: FormSession) -> list[str]:
    """Gives the first answer to every question; yes opens the questions that depend on it. Returns the ids in order."""
    asked = []
    while (question := session.question) is not None:
        asked.append(question.id)
        session.answer(question.values[0] if question.values else "words")
    return asked


def test_every_question_is_asked_once_and_counted(journal: ProgressJournal) -> None:
    session = FormSession(FORM, SurveyPhase.BEFORE, journal)
    assert (session.number, session.open_count) == (1, session.count)
    assert answer_all(session) == BEFORE
    assert (session.number, session.open_count) == (len(BEFORE) + 1, 0)
    assert FormSession(FORM, SurveyPhase.BEFORE, journal).question is None


def test_back_comes_to_answers_of_an_earlier_session_and_on_again_to_each(journal: ProgressJournal) -> None:
    first = FormSession(FORM, SurveyPhase.BEFORE, journal)
    for value in ("doctorate", 2, 3):
        first.answer(value)
    session = FormSession(FORM, SurveyPhase.BEFORE, journal)
    assert session.number == 4
    assert session.go_back()
    assert session.value == 3
    assert session.go_back()
    assert session.value == 2
    session.answer(7)
    assert (session.number, session.value) == (3, 3)
    session.answer(session.value)
    assert (session.number, session.value) == (4, None)
    for _ in range(3):
        assert session.go_back()
    assert not session.go_back()
    assert session.number == 1


def test_an_answer_changed_opens_and_closes_what_depends_on_it(journal: ProgressJournal) -> None:
    session = FormSession(FORM, SurveyPhase.BEFORE, journal)
    while session.question is not None and session.question.id != "installed":
        session.answer(None)
    count = session.count
    session.answer(True)
    assert session.question is not None
    assert session.question.id.startswith("setup.")
    assert session.count > count
    session.go_back()
    session.answer(False)
    assert session.question is None
    assert session.count == count
    session.go_back()
    assert session.question is not None
    assert session.question.id == "installed"


def test_again_asks_the_answered_ones_too(journal: ProgressJournal) -> None:
    answer_all(FormSession(FORM, SurveyPhase.BEFORE, journal))
    again = FormSession(FORM, SurveyPhase.BEFORE, journal, again=True)
    assert (again.number, again.value) == (1, FORM.questions[0].options[0])
    assert answer_all(again) == BEFORE


def test_saving_stays_at_the_question(journal: ProgressJournal) -> None:
    session = FormSession(FORM, SurveyPhase.BEFORE, journal)
    session.save("doctorate")
    assert (session.number, session.value) == (1, "doctorate")
    kept = FormAnswers.from_events(FORM, journal.events(EventKind.FORM))
    assert kept.value("education", SurveyPhase.BEFORE) == "doctorate"


def test_the_phases_follow_each_other(journal: ProgressJournal) -> None:
    assert current_phase(FORM, journal) is SurveyPhase.BEFORE
    answer_all(FormSession(FORM, SurveyPhase.BEFORE, journal))
    assert current_phase(FORM, journal) is SurveyPhase.AFTER
    answer_all(FormSession(FORM, SurveyPhase.AFTER, journal))
    assert current_phase(FORM, journal) is SurveyPhase.AFTER
    journal.add(EventKind.ANSWER, "item", {"chosen": 1, "right": False, "occasion": "quiz"})
    assert current_phase(FORM, journal) is SurveyPhase.QUIZZED


def test_the_values_to_choose_from_are_answers() -> None:
    for question in FORM.questions:
        assert all(question.can_be_answered_with(value) for value in question.values)
        assert bool(question.values) is (question.shape is not AnswerShape.TEXT)
