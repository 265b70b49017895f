"""The medals that are nearest to what a player has driven: those to try for next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from kit.school.game.levels import GameLevel
from kit.school.game.medal import Medal, medal_time, next_rung
from kit.school.game.player_progress import LevelProgress
from kit.school.game.race import DriverKind
from kit.school.game.references import reference_seconds


class MedalInReach(NamedTuple):
    """The next medal of a driver on a level."""

    level: GameLevel
    driver: DriverKind
    medal: Medal
    asked: float
    """The longest time that earns it [s]."""
    seconds: float
    """The driver's best time so far [s]."""

    def describe(self) -> str:
        """``gold on Left turn by hand, 0.31 s away``."""
        away = max(0.01, self.seconds - self.asked)
        return f"{self.medal.title} on {self.level.title} {self.driver.phrase}, {away:.2f} s away"


def medals_in_reach(levels: Sequence[LevelProgress]) -> list[MedalInReach]:
    """The next medal of each driver on each level that was driven, first the one that takes the smallest part of the time off."""
    found = []
    for each in levels:
        reference = reference_seconds(each.level)
        for driver, seconds in each.best_times.items():
            rung = None if reference is None else next_rung(driver, reference, seconds)
            if reference is not None and rung is not None:
                asked = medal_time(rung, reference, driver)
                found.append(MedalInReach(each.level, driver, rung, asked, seconds))
    return sorted(found, key=lambda each: each.seconds / each.asked)
