"""The medals of the game, and the ladder of times that earn them: one for hands, one for programs and agents."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import IntEnum
from types import MappingProxyType
from typing import Final

from kit.school.game.race import DriverKind, RaceFinish


class Medal(IntEnum):
    """The medal of a drive; a greater one is better."""

    NONE = 0
    BRONZE = 1
    SILVER = 2
    GOLD = 3
    MASTER = 4
    RECORD = 5
    """Quicker than the reference drive."""

    @property
    def title(self) -> str:
        return "no medal" if self is Medal.NONE else self.name.lower()


RUNGS: Final = tuple(medal for medal in Medal if medal is not Medal.NONE)
"""Every medal that can be earned, the lowest first."""
_TOP: Final = {Medal.MASTER: 1.02, Medal.RECORD: 1.0}
# By the table of `python -m tests.school.game.measured_drivers`, a tidy program without a map arrives on 17 of 39 levels: on one of
# them in 1.05 times the reference's time, on 11 in up to 1.40, on 5 it is slower or touches something. One that has read the map
# takes 1.03 to 1.49 times that time, an agent trained for the level up to 1.68. A first program of a few lines that arrives from all
# starts takes about 2.1: it is to have a medal, and the next one about a third below it.
_PROGRAM: Final = {Medal.BRONZE: 2.25, Medal.SILVER: 1.40, Medal.GOLD: 1.06, **_TOP}
SHARES: Final[Mapping[DriverKind, Mapping[Medal, float]]] = MappingProxyType(
    {
        DriverKind.HAND: {Medal.BRONZE: 2.0, Medal.SILVER: 1.3, Medal.GOLD: 1.1, **_TOP},
        DriverKind.PROGRAM: _PROGRAM,
        DriverKind.AGENT: _PROGRAM,
    }
)
"""How many times the reference drive's time each driver may take for a medal; for the record, less than that."""


def medal_of(finish: RaceFinish, reference_s: float | None, driver: DriverKind = DriverKind.HAND) -> Medal:
    """The medal of a finish. ``reference_s``: the reference drive's time [s]; None: there are no medals. A
    flawed one gets bronze at best."""
    if not finish.reached or reference_s is None:
        return Medal.NONE
    earned = [medal for medal in RUNGS if finish.seconds <= medal_time(medal, reference_s, driver)]
    best = max(earned, default=Medal.NONE)
    return min(best, Medal.BRONZE) if finish.is_flawed else best


def medal_time(medal: Medal, reference_s: float, driver: DriverKind = DriverKind.HAND) -> float:
    """The longest time that earns a medal [s], in whole hundredths as it is shown: a tick takes one."""
    hundredths = math.floor(round(100.0 * SHARES[driver][medal] * reference_s, 6))
    return (hundredths - (medal is Medal.RECORD)) / 100.0


def rung_in_reach(driver: DriverKind, reference_s: float, seconds: float, is_flawed: bool) -> Medal | None:
    """The highest medal that a drive still earns which is at the goal at once; None: no medal any more."""
    most = Medal.BRONZE if is_flawed else Medal.RECORD
    left = [medal for medal in RUNGS if medal <= most and seconds <= medal_time(medal, reference_s, driver)]
    return max(left, default=None)


def next_rung(driver: DriverKind, reference_s: float, seconds: float | None) -> Medal | None:
    """The lowest medal that a time does not earn; None above the record. ``seconds``: None: nothing was driven."""
    missing = [
        medal for medal in RUNGS if seconds is None or seconds > medal_time(medal, reference_s, driver)
    ]
    return min(missing, default=None)
