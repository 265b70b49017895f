"""Rounds: a fixed set of items, each asked once, such as the quiz or a lesson's questions; then it may begin again."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from kit.school.quiz.answers import Answer, Occasion
from kit.school.quiz.items import Item
from kit.school.quiz.schedule import shuffled

Round = dict[str, Answer]
"""The first answer to each item."""


@dataclass(frozen=True, slots=True)
class Rounds:
    """How often a set of items was gone through, and how far one is."""

    items: tuple[Item, ...]
    finished: tuple[Round, ...]
    under_way: Round
    """Empty: none is."""

    @property
    def last(self) -> Round:
        """The one under way, else the last one finished."""
        return self.under_way or (self.finished[-1] if self.finished else {})

    def left(self, seed: int) -> list[Item]:
        """What the round under way, or a new one, has still to ask, in its order."""
        order = shuffled(self.items, seed, len(self.finished))
        return [item for item in order if item.id not in self.under_way]


def rounds_of(items: Sequence[Item], answers: Iterable[Answer], occasion: Occasion) -> Rounds:
    """What the answers given on that occasion make of these items."""
    wanted = {item.id for item in items}
    finished: list[Round] = []
    current: Round = {}
    for answer in answers:
        if answer.occasion is not occasion or answer.item not in wanted:
            continue
        current.setdefault(answer.item, answer)  # two terminals may ask the same at once
        if len(current) == len(wanted):
            finished.append(current)
            current = {}
    return Rounds(tuple(items), tuple(finished), current)
