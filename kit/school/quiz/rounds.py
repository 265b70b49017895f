"""Rounds: a fixed set of items, each asked once, such as the quiz or a lesson's questions; then it may begin again."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from kit.school.quiz.answers import Occasion, QuizAnswer
from kit.school.quiz.items import QuizItem
from kit.school.quiz.schedule import shuffled

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
    return RoundHistory(tuple(items), tuple(finished), current)
