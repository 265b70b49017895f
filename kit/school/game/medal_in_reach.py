"""The medal that is nearest to what a player has driven: the one to try for next."""

from __future__ import annotations

from collections.abc import Sequence

from kit.school.game.medal import medal_time, next_rung
from kit.school.game.player_progress import LevelProgress
from kit.school.game.references import reference_seconds


def medal_in_reach(levels: Sequence[LevelProgress]) -> str:
    """Names the level, the medal and its time: of all levels that were driven the one whose next medal takes the smallest part
    of the time off. Empty where nothing was driven, or all was won."""
    best, found = float("inf"), ""
    for each in levels:
        reference = reference_seconds(each.level)
        for driver, seconds in each.best_times.items():
            rung = None if reference is None else next_rung(driver, reference, seconds)
            if reference is None or rung is None:
                continue
            asked = medal_time(rung, reference, driver)
            if seconds / asked < best:
                best, found = (
                    seconds / asked,
                    f"{each.level.title}, {driver.phrase}: {rung.title} at {asked:.2f} s",
                )
    return found
