"""What is asked when: topics, not questions, come back after 1, 3, 7 and 21 days (ICER 2019, 10.1145/3291279.3339411).

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
from kit.school.quiz.answers import Answer, Occasion, Outcome, answer_of
from kit.school.quiz.items import Bank, Item, Topic

GAPS: Final = (1, 3, 7, 21)
"""Days from one practice to the next."""
PRACTICE: Final = 4
"""Questions of one practice; fewer where fewer have been met."""
GOOD: Final = 0.75
"""The share of right answers from which on the next gap is a longer one."""


@dataclass(frozen=True, slots=True)
class Standing:
    """Where a topic stands."""

    topic: Topic
    due: date
    gap: int
    """Days between the last practice, or the first answer, and ``due``."""
    asked: tuple[str, ...]
    """Items of the practice under way."""
    size: int
    """Questions of one practice."""

    def left(self, today: date) -> int:
        """Questions to be asked today."""
        return max(0, self.size - len(self.asked)) if self.due <= today else 0


@dataclass(frozen=True, slots=True)
class Schedule:
    """All topics that have begun, the one due first in front."""

    today: date
    standings: tuple[Standing, ...]
    queue: tuple[Item, ...]
    """What is to be asked today, in this order: topics take turns."""
    done: int
    """Questions of the schedule answered today."""
    days: tuple[date, ...]
    """Days on which a practice was finished: each counts once, however much was done."""

    @property
    def next_day(self) -> date | None:
        """When something is due again, after today."""
        return min((each.due for each in self.standings if each.due > self.today), default=None)


@dataclass
class _Track:
    """A topic while the journal is gone through."""

    due: date
    step: int = 0
    asked: dict[str, bool] = field(default_factory=dict)
    """Items of the practice under way, and which were right."""


class _Fold:
    """Goes through the journal once."""

    def __init__(self, bank: Bank, now: datetime) -> None:
        self._bank = bank
        self._items = bank.by_id()
        self._zone = now.tzinfo
        self._today = now.date()
        self._lessons: set[str] = set()
        self.last: dict[str, Answer] = {}
        self.tracks: dict[Topic, _Track] = {}
        self.days: set[date] = set()
        self.done = 0

    def take(self, event: ProgressEvent) -> None:
        if event.kind in (EventKind.STEP, EventKind.ATTEMPT):
            self._lessons.add(event.subject.partition("/")[0])
        answer = answer_of(event)
        item = None if answer is None else self._items.get(answer.item)
        if answer is None or item is None:
            return
        day = answer.time.astimezone(self._zone).date()
        if answer.occasion is Occasion.LESSON:
            self._lessons.add(item.lesson)
        self.last[item.id] = answer
        self.done += answer.occasion is Occasion.SPACED and day == self._today
        track = self.tracks.setdefault(item.topic, _Track(day + timedelta(GAPS[0])))
        if answer.occasion is Occasion.SPACED and day >= track.due:
            self._practise(track, item, answer, day)

    def _practise(self, track: _Track, item: Item, answer: Answer, day: date) -> None:
        track.asked.setdefault(item.id, answer.outcome is Outcome.RIGHT)
        if len(track.asked) < self.size(item.topic):
            return
        good = sum(track.asked.values()) >= GOOD * len(track.asked)
        track.step = min(track.step + 1, len(GAPS) - 1) if good else 0
        track.due, track.asked = day + timedelta(GAPS[track.step]), {}
        self.days.add(day)

    def met(self, topic: Topic) -> list[Item]:
        """What may be asked."""
        return [
            item
            for item in self._bank.of_topic(topic)
            if item.id in self.last or item.lesson in self._lessons
        ]

    def size(self, topic: Topic) -> int:
        return min(PRACTICE, len(self.met(topic)))


def schedule_of(bank: Bank, events: Iterable[ProgressEvent], now: datetime, seed: int = 0) -> Schedule:
    """The schedule that the journal makes, as of ``now`` (with its time zone). ``seed``: the student's."""
    fold = _Fold(bank, now)
    for event in events:
        fold.take(event)
    standings = [
        Standing(topic, track.due, GAPS[track.step], tuple(track.asked), fold.size(topic))
        for topic, track in fold.tracks.items()
    ]
    standings.sort(key=lambda each: (each.due, list(Topic).index(each.topic)))
    return Schedule(
        now.date(),
        tuple(standings),
        tuple(_queue(fold, standings, now.date(), seed)),
        fold.done,
        tuple(sorted(fold.days)),
    )


def shuffled(items: Sequence[Item], seed: int, *circumstances: object) -> list[Item]:
    """The items in an order that is the same for the same student and circumstances, whichever others there are."""
    return sorted(items, key=lambda item: random.Random(f"{seed} {circumstances} {item.id}").random())


def _queue(fold: _Fold, standings: Sequence[Standing], today: date, seed: int) -> list[Item]:
    """Interleaved: always of the topic of which the fewest have been asked in its practice."""
    waiting = {
        each.topic: _order(fold, each, seed)[: each.left(today)] for each in standings if each.left(today)
    }
    asked = {each.topic: len(each.asked) for each in standings}
    queue = []
    while topics := [topic for topic, items in waiting.items() if items]:
        topic = min(topics, key=asked.__getitem__)
        queue.append(waiting[topic].pop(0))
        asked[topic] += 1
    return queue


def _order(fold: _Fold, standing: Standing, seed: int) -> list[Item]:
    """First what was not known the last time, then what was never asked, then what was asked longest ago."""
    items = [item for item in fold.met(standing.topic) if item.id not in standing.asked]

    def urgency(item: Item) -> tuple[int, float]:
        last = fold.last.get(item.id)
        if last is None:
            return 1, 0.0
        return (2 if last.outcome is Outcome.RIGHT else 0), last.time.timestamp()

    return sorted(shuffled(items, seed, standing.due), key=urgency)
