"""What judging an answer of a challenge gave: the medal, a sentence, and the answer beside others."""

from __future__ import annotations

from dataclasses import dataclass

from kit.school.game.medal import Medal


@dataclass(frozen=True, slots=True)
class AnswerComparison:
    """An answer beside others, all in one unit."""

    unit: str
    answer: float
    others: tuple[tuple[str, float], ...]
    """Name and figure of each: the naive answer and the best one, or what earns the medals."""
    more_is_better: bool = False


@dataclass(frozen=True, slots=True)
class Judgement:
    """The result of judging one answer."""

    medal: Medal
    text: str
    """One sentence."""
    comparison: AnswerComparison | None = None
    """None where an answer does not do what is asked, so that no figure can be compared."""


def judge_count(unit: str, text: str, count: int, fewest: int, naive: int, near: int = 1) -> Judgement:
    """Judges an answer of which less is better and ``fewest`` is proved. ``near``: that many more still earn silver."""
    comparison = AnswerComparison(unit, count, (("naive answer", naive), ("best answer", fewest)))
    if count >= naive:
        return Judgement(Medal.NONE, text, comparison)
    medal = Medal.GOLD if count <= fewest else Medal.SILVER if count <= fewest + near else Medal.BRONZE
    return Judgement(medal, text, comparison)
