"""What a player has reached: folded from the journal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from kit.school.game.levels import Level
from kit.school.game.race import Driver, Finish
from kit.school.progress import EventKind, ProgressEvent

STARS = 3


@dataclass(frozen=True, slots=True)
class LevelStanding:
    """One level."""

    level: Level
    is_open: bool
    stars: tuple[bool, bool, bool]
    """Finished, safe, under par: each earned once, by whoever drove."""
    best: Mapping[Driver, float]
    """The shortest time to the target [s], by who drove."""
    drives: int
    """How many there were."""

    @property
    def count(self) -> int:
        return sum(self.stars)


def finish_of(event: ProgressEvent) -> tuple[Driver, Finish] | None:
    """What a ``finish`` event says; None where it cannot be understood."""
    seconds, bumps = event.number("seconds"), event.number("bumps")
    driver = next((each for each in Driver if each.value == event.content.get("driver")), None)
    if driver is None or seconds is None or bumps is None or seconds <= 0.0 or bumps < 0.0:
        return None
    return driver, Finish(event.content.get("reached") is True, seconds, int(bumps))


def standings(levels: Sequence[Level], events: Sequence[ProgressEvent]) -> tuple[LevelStanding, ...]:
    """Every level's standing."""
    finished: dict[str, list[tuple[Driver, Finish]]] = {level.id: [] for level in levels}
    for event in events:
        if (
            event.kind is EventKind.FINISH
            and event.subject in finished
            and (found := finish_of(event)) is not None
        ):
            finished[event.subject].append(found)
    reached = {name for name, drives in finished.items() if any(finish.reached for _, finish in drives)}
    return tuple(
        _standing(level, finished[level.id], not level.after or any(each in reached for each in level.after))
        for level in levels
    )


def improves(standing: LevelStanding, driver: Driver, finish: Finish) -> bool:
    """Whether a drive is the driver's best so far on the level."""
    return finish.reached and finish.seconds < standing.best.get(driver, float("inf"))


def _standing(level: Level, drives: Sequence[tuple[Driver, Finish]], is_open: bool) -> LevelStanding:
    best: dict[Driver, float] = {}
    stars = [False] * STARS
    for driver, finish in drives:
        if finish.reached:
            best[driver] = min(best.get(driver, float("inf")), finish.seconds)
        stars = [had or has for had, has in zip(stars, finish.stars(level.par), strict=True)]
    return LevelStanding(level, is_open or bool(best), (stars[0], stars[1], stars[2]), best, len(drives))
