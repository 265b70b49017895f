"""A sitting: questions one after the other, each answer in the journal before anything is said of it."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Final, Protocol

from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.school.quiz.answers import (
    AnswerChoice,
    AnswerOutcome,
    Occasion,
    QuizAnswer,
    answers_from_events,
    event_content,
)
from kit.school.quiz.items import QuestionBank, QuizItem, lesson_title
from kit.school.quiz.schedule import PracticeSchedule, RoundHistory, build_schedule, round_history

SEED_SUBJECT: Final = "quiz-seed"
"""What the journal calls the student's own seed, by which questions are put in order."""


class QuestionPlan(Protocol):
    """Which questions a sitting asks."""

    @property
    def title(self) -> str: ...

    @property
    def command(self) -> str:
        """What goes on with it."""

    @property
    def occasion(self) -> Occasion: ...

    def remaining(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, restart: bool
    ) -> tuple[int, list[QuizItem]]:
        """How many are done, and what is still to be asked. ``anew``: a finished round begins again."""


@dataclass(frozen=True, slots=True)
class RoundPlan:
    """A set of items, gone through round by round."""

    title: str
    command: str
    occasion: Occasion
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
    """What the schedule has for today."""

    bank: QuestionBank
    title: str = "Due today"
    command: str = "kit quiz --today"
    occasion: Occasion = Occasion.SPACED

    def remaining(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, restart: bool
    ) -> tuple[int, list[QuizItem]]:
        schedule = build_schedule(self.bank, events, now, seed)
        return schedule.done_today, list(schedule.queue)


def quiz_plan(bank: QuestionBank) -> RoundPlan:
    """The quiz."""
    return RoundPlan("The quiz", "kit quiz", Occasion.QUIZ, bank.quiz_items)


def lesson_plan(bank: QuestionBank, lesson: str) -> RoundPlan:
    """A lesson's questions."""
    title = lesson_title(lesson)
    number = lesson.partition("-")[0].lstrip("0")
    return RoundPlan(
        title[0].upper() + title[1:], f"kit quiz {number}", Occasion.LESSON, bank.lesson_items(lesson)
    )


def local_now() -> datetime:
    """Now, in the time zone of this machine."""
    return datetime.now().astimezone()


def student_seed(journal: ProgressJournal) -> int:
    """The student's own seed, drawn once and kept in the journal. Raises ProgressError."""
    for event in journal.events(EventKind.ABOUT, SEED_SUBJECT):
        value = event.content.get("value")
        if isinstance(value, int):
            return value
    seed = secrets.randbelow(2**31)
    journal.add(EventKind.ABOUT, SEED_SUBJECT, {"value": seed})
    return seed


class QuizSession:
    """Asks what a plan has ahead. ``anew``: also where its round is finished."""

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
        """The answers of this sitting."""
        self._update_remaining()

    @property
    def item(self) -> QuizItem | None:
        """What is asked now; None: there is nothing more."""
        return self._remaining[0] if self._remaining else None

    @property
    def question_number(self) -> int:
        """Of the question that is asked now, from 1."""
        return self._done_count + 1

    @property
    def question_count(self) -> int:
        return self._done_count + len(self._remaining)

    def answer(self, choice: AnswerChoice, confidence: int | None = None) -> AnswerOutcome:
        """Notes the answer to ``item`` and goes on. When this returns it is on the disk. Raises ProgressError."""
        item = self.item
        assert item is not None
        content = event_content(item, choice, confidence, self.plan.occasion)
        event = self._journal.add(EventKind.ANSWER, item.id, content, now=self._clock())
        self._events.append(event)
        self.session_answers += answers_from_events([event])
        self._restart = False
        self._update_remaining()
        return choice.outcome(item)

    def all_answers(self) -> list[QuizAnswer]:
        """All answers there are, of every occasion."""
        return answers_from_events(self._events)

    def schedule(self) -> PracticeSchedule:
        return build_schedule(self.bank, self._events, self._clock(), self._seed)

    def _update_remaining(self) -> None:
        self._done_count, self._remaining = self.plan.remaining(
            self._events, self._clock(), self._seed, restart=self._restart
        )
