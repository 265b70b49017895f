"""The player's progress in the game's levels, computed from the journal."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from kit.school.game.levels import GameLevel
from kit.school.game.race import DriverKind, RaceFinish
from kit.school.lessons.lesson_progress import lesson_progress_from_events
from kit.school.lessons.reading import find_lesson
from kit.school.progress import EventKind, ProgressEvent
from kit.world.problems import WorldError

STAR_COUNT = 3


@dataclass(frozen=True, slots=True)
class LevelProgress:
    """The player's progress in one level."""

    level: GameLevel
    is_open: bool
    stars: tuple[bool, bool, bool]
    """Finished, safe, under par: each counts once, no matter which driver earned it."""
    best_times: Mapping[DriverKind, float]
    """The shortest time to the target [s] of each driver."""
    drive_count: int
    """Number of drives."""

    @property
    def star_count(self) -> int:
        return sum(self.stars)


def finish_from_event(event: ProgressEvent) -> tuple[DriverKind, RaceFinish] | None:
    """The driver and finish of a ``finish`` event; None for any other event or malformed content."""
    seconds, bumps = event.number("seconds"), event.number("bumps")
    driver = next((each for each in DriverKind if each.value == event.content.get("driver")), None)
    if driver is None or seconds is None or bumps is None or seconds <= 0.0 or bumps < 0.0:
        return None
    return driver, RaceFinish(event.content.get("reached") is True, seconds, int(bumps))


def completed_lessons(levels: Sequence[GameLevel], events: Sequence[ProgressEvent]) -> frozenset[str]:
    """The names of the lessons that open a level and have been completed. ``events``: of lessons, too."""
    started = {event.subject.partition("/")[0] for event in events}
    completed = set()
    for name in {level.opened_by_lesson for level in levels} & started:
        with contextlib.suppress(LookupError, WorldError):  # a lesson that is away, or wrong, opens nothing
            if lesson_progress_from_events(find_lesson(name), events).is_completed:
                completed.add(name)
    return frozenset(completed)


def level_progress(
    levels: Sequence[GameLevel], events: Sequence[ProgressEvent], lessons: Collection[str] = ()
) -> tuple[LevelProgress, ...]:
    """The progress in every level. ``lessons``: names of those completed."""
    finished: dict[str, list[tuple[DriverKind, RaceFinish]]] = {level.id: [] for level in levels}
    for event in events:
        if (
            event.kind is EventKind.FINISH
            and event.subject in finished
            and (finish := finish_from_event(event)) is not None
        ):
            finished[event.subject].append(finish)
    reached = {name for name, drives in finished.items() if any(finish.reached for _, finish in drives)}
    return tuple(
        _progress_of_level(
            level,
            finished[level.id],
            not level.opened_by
            or any(each in reached for each in level.opened_by)
            or level.opened_by_lesson in lessons,
        )
        for level in levels
    )


def is_best_drive(progress: LevelProgress, driver: DriverKind, finish: RaceFinish) -> bool:
    """Whether a drive is the driver's best one so far."""
    return finish.reached and finish.seconds < progress.best_times.get(driver, float("inf"))


def _progress_of_level(
    level: GameLevel, drives: Sequence[tuple[DriverKind, RaceFinish]], is_open: bool
) -> LevelProgress:
    best: dict[DriverKind, float] = {}
    stars = [False] * STAR_COUNT
    for driver, finish in drives:
        if finish.reached:
            best[driver] = min(best.get(driver, float("inf")), finish.seconds)
        stars = [had or has for had, has in zip(stars, finish.earned_stars(level.par), strict=True)]
    return LevelProgress(level, is_open or bool(best), (stars[0], stars[1], stars[2]), best, len(drives))
