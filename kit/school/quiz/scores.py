"""What the answers say: by topic, with blank apart from wrong and from not sure; and how sure against how often right."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from kit.school.quiz.answers import SURENESS, Answer, Outcome
from kit.school.quiz.items import OPTIONS, Item, Topic

CLAIMED: Final[Mapping[int, float]] = {1: 1 / OPTIONS, 2: 0.5, 3: 0.75, 4: 0.95}
"""How often one should be right who is so sure; a guess among three is right one time in three."""
ENOUGH: Final = 8
"""Answers with a confidence, below which nothing is said of how well it was judged."""
WELL_JUDGED: Final = 0.1
"""Claimed and reached shares nearer than this are called the same."""


@dataclass(frozen=True, slots=True)
class Tally:
    """How many items came out how."""

    right: int = 0
    wrong: int = 0
    not_sure: int = 0
    blank: int = 0
    not_asked: int = 0

    @property
    def items(self) -> int:
        return self.right + self.wrong + self.not_sure + self.blank + self.not_asked


@dataclass(frozen=True, slots=True)
class Level:
    """The answers given with one confidence."""

    confidence: int
    answers: int
    right: int


@dataclass(frozen=True, slots=True)
class Calibration:
    """How sure, and how often right."""

    levels: tuple[Level, ...]
    """From the least sure to the surest; levels nobody used have no answers."""

    @property
    def answers(self) -> int:
        return sum(level.answers for level in self.levels)

    @property
    def claimed(self) -> float:
        """The share of right answers that the confidences claim; 0 without any."""
        claims = sum(CLAIMED[level.confidence] * level.answers for level in self.levels)
        return claims / self.answers if self.answers else 0.0

    @property
    def reached(self) -> float:
        """The share that was right."""
        return sum(level.right for level in self.levels) / self.answers if self.answers else 0.0


def latest(answers: Iterable[Answer]) -> dict[str, Answer]:
    """The last answer to each item."""
    return {answer.item: answer for answer in answers}


def tally(items: Iterable[Item], by_item: Mapping[str, Answer]) -> Tally:
    """How these items came out."""
    counts = Counter(by_item[item.id].outcome if item.id in by_item else None for item in items)
    return Tally(
        counts[Outcome.RIGHT],
        counts[Outcome.WRONG],
        counts[Outcome.NOT_SURE],
        counts[Outcome.BLANK],
        counts[None],
    )


def by_topic(items: Iterable[Item], by_item: Mapping[str, Answer]) -> dict[Topic, Tally]:
    """The same for each topic that has any of the items."""
    of_topic: dict[Topic, list[Item]] = {}
    for item in items:
        of_topic.setdefault(item.topic, []).append(item)
    return {topic: tally(of_topic[topic], by_item) for topic in Topic if topic in of_topic}


def calibration(answers: Iterable[Answer]) -> Calibration:
    """Over all answers that say how sure one was."""
    given: Counter[int] = Counter()
    right: Counter[int] = Counter()
    for answer in answers:
        if answer.confidence is not None:
            given[answer.confidence] += 1
            right[answer.confidence] += answer.outcome is Outcome.RIGHT
    return Calibration(tuple(Level(each, given[each], right[each]) for each in SURENESS))
