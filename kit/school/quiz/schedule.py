"""When a topic of the quiz comes back: after 1, 3, 7 and 21 days (ICER 2019, 10.1145/3291279.3339411)."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import date, datetime, timedelta
from typing import Final

from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.answers import AnswerOccasion, AnswerOutcome, QuizAnswer, answer_from_event
from kit.school.quiz.items import QuestionBank, QuizItem, QuizTopic

GAP_DAYS: Final = (1, 3, 7, 21)
"""Days from one practice to the next."""

PRACTICE_SIZE: Final = 4
"""Questions of one practice; fewer where the topic has fewer known items."""

PASSING_SHARE: Final = 0.75
"""The share of right answers from which the next gap is longer."""


@dataclass(frozen=True, slots=True)
class TopicSchedule:
    """The schedule of one topic."""

    topic: QuizTopic
    due: date
    asked_items: tuple[str, ...]
    """Items asked in the current practice."""
    practice_size: int
    """Questions of one practice."""

    def questions_left(self, today: date) -> int:
        """Number of questions to ask today."""
        return max(0, self.practice_size - len(self.asked_items)) if self.due <= today else 0


@dataclass(frozen=True, slots=True)
class PracticeSchedule:
    """The schedule of all started topics, sorted by due day."""

    today: date
    topics: tuple[TopicSchedule, ...]
    queue: tuple[QuizItem, ...]
    """Items to ask today, in order, with topics interleaved."""
    done_today: int
    """Scheduled questions answered today."""
    practice_days: tuple[date, ...]
    """Days on which a practice was finished, each once."""

    @property
    def next_due(self) -> date | None:
        """The next due day after today; None if there is none."""
        return min((each.due for each in self.topics if each.due > self.today), default=None)


@dataclass
class _TopicState:
    """The state of a topic while the journal is read."""

    due: date
    step: int = 0
    asked: dict[str, bool] = field(default_factory=dict)
    """Items asked in the current practice, and whether they were answered rightly."""


class _ScheduleBuilder:
    """Computes the state of all topics in one pass over the journal."""

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
        if answer.occasion is AnswerOccasion.LESSON:
            self._lessons.add(item.lesson)
        self.last_answers[item.id] = answer
        self.done_today += answer.occasion is AnswerOccasion.SPACED and day == self._today
        track = self.topic_states.setdefault(item.topic, _TopicState(day + timedelta(GAP_DAYS[0])))
        if answer.occasion is AnswerOccasion.SPACED and day >= track.due:
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
        """Items of topics the student has reached: answered before, or of a started lesson."""
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
    """Computes the schedule from the journal as of ``now`` (with its time zone). ``seed``: the student's seed."""
    builder = _ScheduleBuilder(bank, now)
    for event in events:
        builder.add_event(event)
    topics = [
        TopicSchedule(topic, track.due, tuple(track.asked), builder.practice_size(topic))
        for topic, track in builder.topic_states.items()
    ]
    topics.sort(key=lambda each: (each.due, list(QuizTopic).index(each.topic)))
    return PracticeSchedule(
        now.date(),
        tuple(topics),
        tuple(_interleave_topics(builder, topics, now.date(), seed)),
        builder.done_today,
        tuple(sorted(builder.practice_days)),
    )


def shuffle_items(items: Sequence[QuizItem], seed: int, *circumstances: object) -> list[QuizItem]:
    """Shuffles items so that their order depends only on the student's seed and the circumstances, not on other items."""
    return sorted(items, key=lambda item: random.Random(f"{seed} {circumstances} {item.id}").random())


def _interleave_topics(
    builder: _ScheduleBuilder, schedules: Sequence[TopicSchedule], today: date, seed: int
) -> list[QuizItem]:
    """Interleaves topics: the next item is of the topic with the fewest items asked in its practice."""
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
    """Orders a topic's items: last answered wrongly first, then never asked, then the one asked longest ago."""
    items = [item for item in builder.known_items(schedule.topic) if item.id not in schedule.asked_items]

    def urgency(item: QuizItem) -> tuple[int, float]:
        last = builder.last_answers.get(item.id)
        if last is None:
            return 1, 0.0
        return (2 if last.outcome is AnswerOutcome.RIGHT else 0), last.time.timestamp()

    return sorted(shuffle_items(items, seed, schedule.due), key=urgency)


Round = dict[str, QuizAnswer]
"""Item id -> first answer to it in this round."""


@dataclass(frozen=True, slots=True)
class RoundHistory:
    """The finished rounds of a set of items, and the current one."""

    items: tuple[QuizItem, ...]
    finished: tuple[Round, ...]
    current: Round
    """Empty: no round has been started."""

    @property
    def last(self) -> Round:
        """The current round, else the last finished one."""
        return self.current or (self.finished[-1] if self.finished else {})

    def remaining(self, seed: int) -> list[QuizItem]:
        """The remaining items of the current round, or of a new one, in order."""
        order = shuffle_items(self.items, seed, len(self.finished))
        return [item for item in order if item.id not in self.current]


def round_history(
    items: Sequence[QuizItem], answers: Iterable[QuizAnswer], occasion: AnswerOccasion
) -> RoundHistory:
    """Computes the rounds of these items from the answers of one occasion."""
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
