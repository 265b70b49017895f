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
    rungs: tuple[tuple[Medal, float], ...]
    """What each medal asks for, the lowest first."""
    more_is_better: bool = False

    @property
    def medal(self) -> Medal:
        """What the figure earns."""
        return max((medal for medal, figure in self.rungs if self._reaches(figure)), default=Medal.NONE)

    @property
    def next_rung(self) -> tuple[Medal, float] | None:
        """The next medal and what it asks for; None above the last one."""
        return next(((medal, figure) for medal, figure in self.rungs if medal > self.medal), None)

    def _reaches(self, figure: float) -> bool:
        return self.answer >= figure if self.more_is_better else self.answer <= figure


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
    rungs = ((Medal.BRONZE, naive - 1), (Medal.SILVER, min(fewest + near, naive - 1)), (Medal.GOLD, fewest))
    comparison = AnswerComparison(unit, count, (("simple answer", naive), ("best answer", fewest)), rungs)
    return Judgement(comparison.medal, text, comparison)
