"""A quiz session: asks one question after the other, and records each answer before any feedback is shown."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Final, Protocol

from kit.school.lessons.reading import lesson_number
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.school.quiz.answers import (
    AnswerChoice,
    AnswerOccasion,
    AnswerOutcome,
    QuizAnswer,
    answers_from_events,
    event_content,
)
from kit.school.quiz.items import QuestionBank, QuizItem, lesson_reference
from kit.school.quiz.schedule import PracticeSchedule, RoundHistory, build_schedule, round_history

SEED_SUBJECT: Final = "quiz-seed"
"""The journal's subject for the student's own seed, by which questions are shuffled."""


class QuestionPlan(Protocol):
    """The questions of a quiz session."""

    @property
    def title(self) -> str: ...

    @property
    def command(self) -> str:
        """The command that continues the plan."""

    @property
    def occasion(self) -> AnswerOccasion: ...

    def remaining(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, restart: bool
    ) -> tuple[int, list[QuizItem]]:
        """Returns the number of answered questions and the remaining items. ``restart``: a finished round starts again."""


@dataclass(frozen=True, slots=True)
class QuizRoundPlan:
    """A set of items, asked round by round."""

    title: str
    command: str
    occasion: AnswerOccasion
    items: tuple[QuizItem, ...]

    def remaining(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, restart: bool
    ) -> tuple[int, list[QuizItem]]:
        history = self.history(answers_from_events(events))
        if history.finished and not history.current and not restart:
            return len(self.items), []
        return len(history.current), history.remaining(seed)

    def history(self, answers: Sequence[QuizAnswer]) -> RoundHistory:
        return round_history(self.items, answers, self.occasion)


@dataclass(frozen=True, slots=True)
class PracticePlan:
    """The questions that the schedule has for today."""

    bank: QuestionBank
    title: str = "Due today"
    command: str = "kit quiz --today"
    occasion: AnswerOccasion = AnswerOccasion.SPACED

    def remaining(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, restart: bool
    ) -> tuple[int, list[QuizItem]]:
        schedule = build_schedule(self.bank, events, now, seed)
        return schedule.done_today, list(schedule.queue)


def quiz_plan(bank: QuestionBank) -> QuizRoundPlan:
    """The plan of the quiz."""
    return QuizRoundPlan("The quiz", "kit quiz", AnswerOccasion.QUIZ, bank.quiz_items)


def lesson_plan(bank: QuestionBank, lesson: str) -> QuizRoundPlan:
    """The plan of a lesson's questions."""
    title = lesson_reference(lesson)
    number = lesson_number(lesson)
    return QuizRoundPlan(
        title[0].upper() + title[1:], f"kit quiz {number}", AnswerOccasion.LESSON, bank.lesson_items(lesson)
    )


def local_now() -> datetime:
    """The current time, in the time zone of this machine."""
    return datetime.now().astimezone()


def student_seed(journal: ProgressJournal) -> int:
    """The student's own seed, drawn once and stored in the journal. Raises ProgressError."""
    for event in journal.events(EventKind.ABOUT, SEED_SUBJECT):
        value = event.content.get("value")
        if isinstance(value, int):
            return value
    seed = secrets.randbelow(2**31)
    journal.add(EventKind.ABOUT, SEED_SUBJECT, {"value": seed})
    return seed


class QuizSession:
    """Asks the remaining questions of a plan. ``restart``: starts a new round where the last one is finished."""

    def __init__(
        self,
        journal: ProgressJournal,
        bank: QuestionBank,
        plan: QuestionPlan,
        *,
        seed: int,
        restart: bool = False,
        clock: Callable[[], datetime] = local_now,
    ) -> None:
        self.bank = bank
        self.plan = plan
        self._journal = journal
        self._seed = seed
        self._restart = restart
        self._clock = clock
        self._events = journal.events()
        self.session_answers: list[QuizAnswer] = []
        """The answers given in this session."""
        self._update_remaining()

    @property
    def current_item(self) -> QuizItem | None:
        """The current question; None: there is none left."""
        return self._remaining[0] if self._remaining else None

    @property
    def question_number(self) -> int:
        """Number of the current question, from 1."""
        return self._done_count + 1

    @property
    def question_count(self) -> int:
        return self._done_count + len(self._remaining)

    def answer(self, choice: AnswerChoice, confidence: int | None = None) -> AnswerOutcome:
        """Records the answer to ``item`` and moves on. It is on the disk when this returns. Raises ProgressError."""
        item = self.current_item
        assert item is not None
        content = event_content(item, choice, confidence, self.plan.occasion)
        event = self._journal.add(EventKind.ANSWER, item.id, content, now=self._clock())
        self._events.append(event)
        self.session_answers += answers_from_events([event])
        self._restart = False
        self._update_remaining()
        return choice.outcome_for(item)

    def all_answers(self) -> list[QuizAnswer]:
        """All answers in the journal, of every occasion."""
        return answers_from_events(self._events)

    def build_schedule(self) -> PracticeSchedule:
        return build_schedule(self.bank, self._events, self._clock(), self._seed)

    def _update_remaining(self) -> None:
        self._done_count, self._remaining = self.plan.remaining(
            self._events, self._clock(), self._seed, restart=self._restart
        )
