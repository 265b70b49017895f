"""The medals of the game, and the times that earn them."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import Final

from kit.school.game.race import RaceFinish

GOLD_SHARE: Final = 1.02
"""Gold: at most this many times the reference drive's time, and nothing touched."""
SILVER_SHARE: Final = 1.05
"""Silver, likewise."""


class Medal(IntEnum):
    """The medal of a drive; a greater one is better."""

    NONE = 0
    BRONZE = 1
    """The goal was reached."""
    SILVER = 2
    GOLD = 3

    @property
    def title(self) -> str:
        return "no medal" if self is Medal.NONE else self.name.lower()


def medal_of(finish: RaceFinish, reference_s: float | None) -> Medal:
    """The medal of a finish. ``reference_s``: the reference drive's time [s]; None: there is only bronze."""
    if not finish.reached:
        return Medal.NONE
    if finish.collisions or reference_s is None:
        return Medal.BRONZE
    earned = (
        medal for medal in (Medal.GOLD, Medal.SILVER) if finish.seconds <= medal_time(medal, reference_s)
    )
    return next(earned, Medal.BRONZE)


def medal_time(medal: Medal, reference_s: float) -> float:
    """The longest time that earns gold or silver [s], in whole hundredths as it is shown: a tick takes one."""
    share = GOLD_SHARE if medal is Medal.GOLD else SILVER_SHARE
    return math.floor(round(100.0 * share * reference_s, 6)) / 100.0
