"""What ordinary drivers took on each level: a hand of ordinary skill, a tidy program, an agent trained by the kit's preset.

They were measured, and ship beside the reference drives.
"""

from __future__ import annotations

import csv
from collections.abc import Collection, Mapping
from functools import cache
from types import MappingProxyType
from typing import Final

from kit.school.game.levels import GameLevel
from kit.school.game.race import DriverKind
from kit.school.lessons.reading import lessons_folder

MEASURED_FILE: Final = "measured_drivers.csv"
MEASURED: Final[Mapping[str, DriverKind]] = MappingProxyType(
    {
        "keys": DriverKind.HAND,
        "laser": DriverKind.PROGRAM,
        "map": DriverKind.PROGRAM,
        "agent": DriverKind.AGENT,
    }
)
"""Who drives, by the name in the file; of two programs the quicker one counts."""
NONE_MEASURED: Final[Mapping[DriverKind, float]] = MappingProxyType({})


@cache
def _load() -> dict[str, dict[DriverKind, float]]:
    """The times [s] of drives that have arrived without a flaw, by level and driver; none where there is no such file."""
    times: dict[str, dict[DriverKind, float]] = {}
    try:
        with (lessons_folder() / MEASURED_FILE).open(newline="") as file:
            for line in csv.DictReader(file):
                driver = MEASURED.get(line["driver"])
                is_flawed = int(line["collisions"]) > 0 or bool(line["remark"])
                if driver is not None and line["reached"] == "yes" and not is_flawed:
                    known, seconds = times.setdefault(line["level"], {}), float(line["seconds"])
                    known[driver] = min(known.get(driver, seconds), seconds)
    except FileNotFoundError:
        return {}
    return times


def ordinary_drives(level: GameLevel, drivers: Collection[DriverKind]) -> Mapping[DriverKind, float]:
    """The times [s] of those ordinary drivers that have arrived on a level without a flaw."""
    known = _load().get(level.id, NONE_MEASURED)
    return {driver: known[driver] for driver in drivers if driver in known}
