"""A sitting: questions one after the other, each answer in the journal before anything is said of it."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Final, Protocol

from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.school.quiz.answers import Answer, Choice, Occasion, Outcome, answers_of, content_of
from kit.school.quiz.items import Bank, Item, lesson_title
from kit.school.quiz.rounds import Rounds, rounds_of
from kit.school.quiz.schedule import Schedule, schedule_of

SEED: Final = "quiz-seed"
"""What the journal calls the student's own seed, by which questions are put in order."""


class Plan(Protocol):
    """Which questions a sitting asks."""

    @property
    def title(self) -> str: ...

    @property
    def command(self) -> str:
        """What goes on with it."""

    @property
    def occasion(self) -> Occasion: ...

    def ahead(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, anew: bool
    ) -> tuple[int, list[Item]]:
        """How many are done, and what is still to be asked. ``anew``: a finished round begins again."""


@dataclass(frozen=True, slots=True)
class InRounds:
    """A set of items, gone through round by round."""

    title: str
    command: str
    occasion: Occasion
    items: tuple[Item, ...]

    def ahead(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, anew: bool
    ) -> tuple[int, list[Item]]:
        rounds = self.rounds(answers_of(events))
        if rounds.finished and not rounds.under_way and not anew:
            return len(self.items), []
        return len(rounds.under_way), rounds.left(seed)

    def rounds(self, answers: Sequence[Answer]) -> Rounds:
        return rounds_of(self.items, answers, self.occasion)


@dataclass(frozen=True, slots=True)
class Today:
    """What the schedule has for today."""

    bank: Bank
    title: str = "Due today"
    command: str = "kit quiz --today"
    occasion: Occasion = Occasion.SPACED

    def ahead(
        self, events: Sequence[ProgressEvent], now: datetime, seed: int, *, anew: bool
    ) -> tuple[int, list[Item]]:
        schedule = schedule_of(self.bank, events, now, seed)
        return schedule.done, list(schedule.queue)


def the_twelve(bank: Bank) -> InRounds:
    """The quiz."""
    return InRounds("The quiz", "kit quiz", Occasion.QUIZ, bank.twelve)


def of_lesson(bank: Bank, lesson: str) -> InRounds:
    """A lesson's questions."""
    title = lesson_title(lesson)
    number = lesson.partition("-")[0].lstrip("0")
    return InRounds(
        title[0].upper() + title[1:], f"kit quiz {number}", Occasion.LESSON, bank.of_lesson(lesson)
    )


def local_now() -> datetime:
    """Now, in the time zone of this machine."""
    return datetime.now().astimezone()


def student_seed(journal: ProgressJournal) -> int:
    """The student's own seed, drawn once and kept in the journal. Raises ProgressError."""
    for event in journal.events(EventKind.ABOUT, SEED):
        value = event.content.get("value")
        if isinstance(value, int):
            return value
    seed = secrets.randbelow(2**31)
    journal.add(EventKind.ABOUT, SEED, {"value": seed})
    return seed


class Sitting:
    """Asks what a plan has ahead. ``anew``: also where its round is finished."""

    def __init__(
        self,
        journal: ProgressJournal,
        bank: Bank,
        plan: Plan,
        *,
        seed: int,
        anew: bool = False,
        clock: Callable[[], datetime] = local_now,
    ) -> None:
        self.bank = bank
        self.plan = plan
        self._progress = journal
        self._seed = seed
        self._anew = anew
        self._clock = clock
        self._events = journal.events()
        self.given: list[Answer] = []
        """The answers of this sitting."""
        self._look_ahead()

    @property
    def item(self) -> Item | None:
        """What is asked now; None: there is nothing more."""
        return self._left[0] if self._left else None

    @property
    def number(self) -> int:
        """Of the question that is asked now, from 1."""
        return self._done + 1

    @property
    def total(self) -> int:
        return self._done + len(self._left)

    def answer(self, choice: Choice, confidence: int | None = None) -> Outcome:
        """Notes the answer to ``item`` and goes on. When this returns it is on the disk. Raises ProgressError."""
        item = self.item
        assert item is not None
        content = content_of(item, choice, confidence, self.plan.occasion)
        event = self._progress.add(EventKind.ANSWER, item.id, content, now=self._clock())
        self._events.append(event)
        self.given += answers_of([event])
        self._anew = False
        self._look_ahead()
        return choice.outcome(item)

    def answers(self) -> list[Answer]:
        """All answers there are, of every occasion."""
        return answers_of(self._events)

    def schedule(self) -> Schedule:
        return schedule_of(self.bank, self._events, self._clock(), self._seed)

    def _look_ahead(self) -> None:
        self._done, self._left = self.plan.ahead(self._events, self._clock(), self._seed, anew=self._anew)
