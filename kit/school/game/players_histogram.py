"""What the players of this machine needed for a level: a histogram of the drives on its leaderboard, which were all run again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from kit.school.game.leaderboard import leaderboard_folder, read_entries
from kit.school.game.levels import GameLevel
from kit.school.game.race import DriverKind

LEAST_PLAYERS: Final = 5
"""Of fewer a histogram says more about persons than about the level, and none is made."""
BINS: Final = 5


@dataclass(frozen=True, slots=True)
class HistogramBin:
    """How many players needed between ``low`` and ``high``."""

    low: float
    high: float
    count: int
    holds_own: bool
    """Whether one's own figure is here."""


def histogram(figures: Sequence[float], own: float) -> tuple[HistogramBin, ...]:
    """Five bins of equal width over the figures of all players; none where there are too few of them.

    >>> [each.count for each in histogram([8.0, 9.0, 9.0, 10.0, 18.0], 9.5)]
    [4, 0, 0, 0, 1]
    >>> histogram([8.0, 9.0], 9.5)
    ()
    """
    if len(figures) < LEAST_PLAYERS:
        return ()
    low, high = min(*figures, own), max(*figures, own)
    width = (high - low) / BINS or 1.0

    def number(figure: float) -> int:
        return min(BINS - 1, int((figure - low) / width))

    counts = [0] * BINS
    for figure in figures:
        counts[number(figure)] += 1
    return tuple(
        HistogramBin(low + at * width, low + (at + 1) * width, count, number(own) == at)
        for at, count in enumerate(counts)
    )


def seconds_needed(level: GameLevel, driver: DriverKind) -> list[float]:
    """The times of all who have joined this machine's leaderboard, by the same kind of driver [s]. Runs drives that were not
    judged before."""
    return [each.seconds for each in read_entries(leaderboard_folder(), [level]) if each.driver is driver]
