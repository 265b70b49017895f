"""A quiz session: answers are on the disk at once, and a new session continues there."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from kit.school.progress import EventKind, ProgressError, ProgressJournal
from kit.school.quiz.answers import NOT_SURE, AnswerChoice, AnswerOutcome
from kit.school.quiz.items import QuizTopic, build_bank
from kit.school.quiz.quiz_session import (
    SEED_SUBJECT,
    PracticePlan,
    QuizSession,
    lesson_plan,
    quiz_plan,
    student_seed,
)
from tests.school.quiz.item_builders import MONDAY, bank, item

BANK = build_bank(
    [*bank(ros2=5).items, *(item(f"idea-{i}", QuizTopic.RL, lesson="09-rl", idea=i) for i in (1, 2, 3))]
)


class Clock:
    def __init__(self) -> None:
        self.now = MONDAY

    def __call__(self) -> datetime:
        self.now += timedelta(seconds=1)
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_each_answer_is_in_the_journal_before_the_next_question(tmp_path: Path, clock: Clock) -> None:
    with ProgressJournal(tmp_path) as progress, ProgressJournal(tmp_path) as another:
        session = QuizSession(progress, BANK, quiz_plan(BANK), seed=1, clock=clock)
        for count in range(1, 4):
            asked = session.current_item
            assert asked is not None
            assert session.question_number == count
            assert session.answer(AnswerChoice(asked.right_option), 4) is AnswerOutcome.RIGHT
            (*_, event) = another.events(EventKind.ANSWER)
            assert len(another.events(EventKind.ANSWER)) == count
            assert event.subject == asked.id
            assert event.content == {
                "chosen": asked.right_option, "not_sure": False, "right": True, "confidence": 4,
                "occasion": "quiz", "topic": "rl",
            }  # fmt: skip
        assert session.current_item is None


def test_a_new_session_continues_where_the_last_one_stopped(tmp_path: Path, clock: Clock) -> None:
    plan = lesson_plan(BANK, "01-ros2")
    order: list[str] = []
    for session_number in range(5):
        with ProgressJournal(tmp_path) as progress:
            session = QuizSession(progress, BANK, plan, seed=student_seed(progress), clock=clock)
            assert (session.question_number, session.question_count) == (session_number + 1, 5)
            assert session.current_item is not None
            order.append(session.current_item.id)
            session.answer(NOT_SURE)
    assert sorted(order) == [f"ros2-{i}" for i in range(5)]


def test_a_finished_round_restarts_only_when_asked(tmp_path: Path, clock: Clock) -> None:
    plan = quiz_plan(BANK)
    with ProgressJournal(tmp_path) as progress:
        first = QuizSession(progress, BANK, plan, seed=1, clock=clock)
        while first.current_item is not None:
            first.answer(AnswerChoice(0), 1)
        assert QuizSession(progress, BANK, plan, seed=1, clock=clock).current_item is None
        again = QuizSession(progress, BANK, plan, seed=1, clock=clock, restart=True)
        count = 0
        while again.current_item is not None:
            again.answer(AnswerChoice(1), 1)
            count += 1
            if count == 1:  # left and come back to without the word
                again = QuizSession(progress, BANK, plan, seed=1, clock=clock)
        assert count == 3
        assert len(plan.history(again.all_answers()).finished) == 2


def test_todays_practice_ends_and_says_when_next(tmp_path: Path, clock: Clock) -> None:
    with ProgressJournal(tmp_path) as progress:
        lesson = QuizSession(progress, BANK, lesson_plan(BANK, "01-ros2"), seed=1, clock=clock)
        lesson.answer(AnswerChoice(0), 2)
        assert QuizSession(progress, BANK, PracticePlan(BANK), seed=1, clock=clock).current_item is None
        clock.now += timedelta(days=1)
        today = QuizSession(progress, BANK, PracticePlan(BANK), seed=1, clock=clock)
        assert (today.question_number, today.question_count) == (1, 4)
        for number in range(1, 5):
            assert today.question_number == number
            assert today.question_count == 4
            today.answer(AnswerChoice(0), 3)
        assert today.current_item is None
        (schedule_of_topic,) = today.build_schedule().topics
        assert schedule_of_topic.due == (clock.now + timedelta(days=3)).date()


def test_an_answer_that_cannot_be_kept_is_not_taken(tmp_path: Path, clock: Clock) -> None:
    progress = ProgressJournal(tmp_path)
    session = QuizSession(progress, BANK, quiz_plan(BANK), seed=1, clock=clock)
    asked = session.current_item
    progress.close()
    with pytest.raises(ProgressError):
        session.answer(AnswerChoice(0), 1)
    assert session.current_item is asked
    assert session.session_answers == []


def test_the_seed_is_drawn_once(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        seed = student_seed(progress)
        assert student_seed(progress) == seed
        assert len(progress.events(EventKind.ABOUT, SEED_SUBJECT)) == 1
