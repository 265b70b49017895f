"""Schedules quiz questions: topics, not questions, come back after 1, 3, 7 and 21 days (ICER 2019,
10.1145/3291279.3339411); and counts rounds through a fixed set of questions, such as the quiz or a lesson's.

A topic enters the schedule with the first question answered of it. When it is due, a *practice* of a few of its
questions is asked; if most are right the topic comes back after the next longer gap, else after a day. Only what the
student has met is asked: items answered before, and all of a lesson that was begun. Everything is a pure function of
the journal and of now, whose time zone says what a day is.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import date, datetime, timedelta
from typing import Final

from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.answers import AnswerOutcome, Occasion, QuizAnswer, answer_from_event
from kit.school.quiz.items import QuestionBank, QuizItem, QuizTopic

GAP_DAYS: Final = (1, 3, 7, 21)
"""Days from one practice to the next."""
PRACTICE_SIZE: Final = 4
"""Questions of one practice; fewer where fewer have been met."""
PASSING_SHARE: Final = 0.75
"""The share of right answers from which on the next gap is a longer one."""


@dataclass(frozen=True, slots=True)
class TopicSchedule:
    """Where a topic stands."""

    topic: QuizTopic
    due: date
    gap_days: int
    """Days between the last practice, or the first answer, and ``due``."""
    asked_items: tuple[str, ...]
    """Items of the practice under way."""
    practice_size: int
    """Questions of one practice."""

    def questions_left(self, today: date) -> int:
        """Questions to be asked today."""
        return max(0, self.practice_size - len(self.asked_items)) if self.due <= today else 0


@dataclass(frozen=True, slots=True)
class PracticeSchedule:
    """All topics that have begun, the one due first in front."""

    today: date
    topics: tuple[TopicSchedule, ...]
    queue: tuple[QuizItem, ...]
    """What is to be asked today, in this order: topics take turns."""
    done_today: int
    """Questions of the schedule answered today."""
    practice_days: tuple[date, ...]
    """Days on which a practice was finished: each counts once, however much was done."""

    @property
    def next_due(self) -> date | None:
        """When something is due again, after today."""
        return min((each.due for each in self.topics if each.due > self.today), default=None)


@dataclass
class _TopicState:
    """A topic while the journal is gone through."""

    due: date
    step: int = 0
    asked: dict[str, bool] = field(default_factory=dict)
    """Items of the practice under way, and which were right."""


class _ScheduleBuilder:
    """Goes through the journal once."""

    def __init__(self, bank: QuestionBank, now: datetime) -> None:
        self._bank = bank
        self._items = bank.items_by_id()
        self._zone = now.tzinfo
        self._today = now.date()
        self._lessons: set[str] = set()
        self.last_answers: dict[str, QuizAnswer] = {}
        self.topic_states: dict[QuizTopic, _TopicState] = {}
        self.practice_days: set[date] = set()
        self.done_today = 0

    def add_event(self, event: ProgressEvent) -> None:
        if event.kind in (EventKind.STEP, EventKind.ATTEMPT):
            self._lessons.add(event.subject.partition("/")[0])
        answer = answer_from_event(event)
        item = None if answer is None else self._items.get(answer.item)
        if answer is None or item is None:
            return
        day = answer.time.astimezone(self._zone).date()
        if answer.occasion is Occasion.LESSON:
            self._lessons.add(item.lesson)
        self.last_answers[item.id] = answer
        self.done_today += answer.occasion is Occasion.SPACED and day == self._today
        track = self.topic_states.setdefault(item.topic, _TopicState(day + timedelta(GAP_DAYS[0])))
        if answer.occasion is Occasion.SPACED and day >= track.due:
            self._add_practice_answer(track, item, answer, day)

    def _add_practice_answer(self, track: _TopicState, item: QuizItem, answer: QuizAnswer, day: date) -> None:
        track.asked.setdefault(item.id, answer.outcome is AnswerOutcome.RIGHT)
        if len(track.asked) < self.practice_size(item.topic):
            return
        good = sum(track.asked.values()) >= PASSING_SHARE * len(track.asked)
        track.step = min(track.step + 1, len(GAP_DAYS) - 1) if good else 0
        track.due, track.asked = day + timedelta(GAP_DAYS[track.step]), {}
        self.practice_days.add(day)

    def known_items(self, topic: QuizTopic) -> list[QuizItem]:
        """What may be asked."""
        return [
            item
            for item in self._bank.topic_items(topic)
            if item.id in self.last_answers or item.lesson in self._lessons
        ]

    def practice_size(self, topic: QuizTopic) -> int:
        return min(PRACTICE_SIZE, len(self.known_items(topic)))


def build_schedule(
    bank: QuestionBank, events: Iterable[ProgressEvent], now: datetime, seed: int = 0
) -> PracticeSchedule:
    """The schedule that the journal makes, as of ``now`` (with its time zone). ``seed``: the student's."""
    builder = _ScheduleBuilder(bank, now)
    for event in events:
        builder.add_event(event)
    topics = [
        TopicSchedule(
            topic, track.due, GAP_DAYS[track.step], tuple(track.asked), builder.practice_size(topic)
        )
        for topic, track in builder.topic_states.items()
    ]
    topics.sort(key=lambda each: (each.due, list(QuizTopic).index(each.topic)))
    return PracticeSchedule(
        now.date(),
        tuple(topics),
        tuple(_queue(builder, topics, now.date(), seed)),
        builder.done_today,
        tuple(sorted(builder.practice_days)),
    )


def shuffled(items: Sequence[QuizItem], seed: int, *circumstances: object) -> list[QuizItem]:
    """The items in an order that is the same for the same student and circumstances, whichever others there are."""
    return sorted(items, key=lambda item: random.Random(f"{seed} {circumstances} {item.id}").random())


def _queue(
    builder: _ScheduleBuilder, schedules: Sequence[TopicSchedule], today: date, seed: int
) -> list[QuizItem]:
    """Interleaved: always of the topic of which the fewest have been asked in its practice."""
    waiting = {
        each.topic: _ordered_items(builder, each, seed)[: each.questions_left(today)]
        for each in schedules
        if each.questions_left(today)
    }
    asked = {each.topic: len(each.asked_items) for each in schedules}
    queue = []
    while topics := [topic for topic, items in waiting.items() if items]:
        topic = min(topics, key=asked.__getitem__)
        queue.append(waiting[topic].pop(0))
        asked[topic] += 1
    return queue


def _ordered_items(builder: _ScheduleBuilder, schedule: TopicSchedule, seed: int) -> list[QuizItem]:
    """First what was not known the last time, then what was never asked, then what was asked longest ago."""
    items = [item for item in builder.known_items(schedule.topic) if item.id not in schedule.asked_items]

    def urgency(item: QuizItem) -> tuple[int, float]:
        last = builder.last_answers.get(item.id)
        if last is None:
            return 1, 0.0
        return (2 if last.outcome is AnswerOutcome.RIGHT else 0), last.time.timestamp()

    return sorted(shuffled(items, seed, schedule.due), key=urgency)


Round = dict[str, QuizAnswer]
"""The first answer to each item."""


@dataclass(frozen=True, slots=True)
class RoundHistory:
    """How often a set of items was gone through, and how far one is."""

    items: tuple[QuizItem, ...]
    finished: tuple[Round, ...]
    current: Round
    """Empty: none is."""

    @property
    def last(self) -> Round:
        """The one under way, else the last one finished."""
        return self.current or (self.finished[-1] if self.finished else {})

    def remaining(self, seed: int) -> list[QuizItem]:
        """What the round under way, or a new one, has still to ask, in its order."""
        order = shuffled(self.items, seed, len(self.finished))
        return [item for item in order if item.id not in self.current]


def round_history(
    items: Sequence[QuizItem], answers: Iterable[QuizAnswer], occasion: Occasion
) -> RoundHistory:
    """What the answers given on that occasion make of these items."""
    item_ids = {item.id for item in items}
    finished: list[Round] = []
    current: Round = {}
    for answer in answers:
        if answer.occasion is not occasion or answer.item not in item_ids:
            continue
        current.setdefault(answer.item, answer)  # two terminals may ask the same at once
        if len(current) == len(item_ids):
            finished.append(current)
            current = {}
    return RoundHistory(tuple(items), tuple(finished), current)
