"""The player's progress in the game's levels, computed from the journal."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from kit.school.game.levels import GameLevel
from kit.school.game.medals import ExtraRule, Medal
from kit.school.game.race import EDITION, DriverKind, RaceFinish
from kit.school.lessons.catalogue import lesson_progress_from_events
from kit.school.lessons.reading import find_lesson
from kit.school.progress import EventKind, ProgressEvent
from kit.world.problems import WorldError

BELTS: Final = ("no", "white", "yellow", "green", "blue", "brown", "black")
STAR_COUNT = 3
"""Of a level in the first edition."""


@dataclass(frozen=True, slots=True)
class LevelProgress:
    """The player's progress in one level."""

    level: GameLevel
    is_open: bool
    medals: Mapping[DriverKind, Medal]
    """The best medal of each driver that has one."""
    rules: frozenset[ExtraRule]
    """Extra rules that a drive has kept: a star each."""
    first_edition: tuple[bool, bool, bool]
    """Stars of the game's first edition: finished, safe, under par."""
    best_times: Mapping[DriverKind, float]
    """The shortest time [s] of each driver that counts for medals."""
    drive_count: int
    """Number of drives."""

    @property
    def best_medal(self) -> Medal:
        return max(self.medals.values(), default=Medal.NONE)

    @property
    def star_count(self) -> int:
        """Stars of extra rules."""
        return len(self.rules)


@dataclass(frozen=True, slots=True)
class RecordedDrive:
    """A drive of a level, as the journal has it."""

    driver: DriverKind
    finish: RaceFinish
    edition: int
    medal: Medal
    rules: frozenset[ExtraRule]
    is_shipped: bool
    """Whether one of the kit's own controllers drove: it earned nothing."""


def drive_from_event(event: ProgressEvent) -> RecordedDrive | None:
    """The drive of a ``finish`` event; None for any other event or malformed content."""
    seconds, bumps = event.number("seconds"), event.number("bumps")
    driver = next((each for each in DriverKind if each.value == event.content.get("driver")), None)
    if driver is None or seconds is None or bumps is None or seconds <= 0.0 or bumps < 0.0:
        return None
    finish = RaceFinish(event.content.get("reached") is True, seconds, int(bumps))
    rules = event.content.get("rules")
    medal = int(event.number("medal") or 0)
    return RecordedDrive(
        driver,
        finish,
        int(event.number("edition") or 1),
        Medal(medal) if finish.reached and medal in tuple(Medal) else Medal.NONE,
        frozenset(rule for rule in ExtraRule if isinstance(rules, list) and rule.value in rules),
        event.content.get("shipped") is True,
    )


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
    levels: Sequence[GameLevel],
    events: Sequence[ProgressEvent],
    lessons: Collection[str] = (),
) -> tuple[LevelProgress, ...]:
    """The progress in every level. ``lessons``: names of those completed; each opens the levels that it prepares."""
    drives: dict[str, list[RecordedDrive]] = {level.id: [] for level in levels}
    for event in events:
        if (
            event.kind is EventKind.FINISH
            and event.subject in drives
            and (drive := drive_from_event(event)) is not None
        ):
            drives[event.subject].append(drive)
    reached = {
        name
        for name, every in drives.items()
        if any(each.finish.reached and not each.is_shipped for each in every)
    }
    return tuple(
        _progress_of_level(
            level,
            drives[level.id],
            not level.opened_by
            or level.opened_by_lesson in lessons
            or any(each in reached for each in level.opened_by),
        )
        for level in levels
    )


def belt_of(progress: Sequence[LevelProgress]) -> str:
    """The belt of a world: white for its first medal, yellow for one on every level, green and blue for silver on half of
    the levels and on all, brown and black likewise for gold."""
    best = [each.best_medal for each in progress]

    def share(medal: Medal) -> float:
        return sum(each >= medal for each in best) / len(best) if best else 0.0

    steps = [
        share(Medal.BRONZE) > 0.0,
        share(Medal.BRONZE) == 1.0,
        share(Medal.SILVER) >= 0.5,
        share(Medal.SILVER) == 1.0,
        share(Medal.GOLD) >= 0.5,
        share(Medal.GOLD) == 1.0,
    ]
    return BELTS[next((number for number in range(len(steps), 0, -1) if all(steps[:number])), 0)]


def is_best_drive(progress: LevelProgress, driver: DriverKind, finish: RaceFinish) -> bool:
    """Whether a drive is the driver's best one so far."""
    return finish.reached and finish.seconds < progress.best_times.get(driver, float("inf"))


def _progress_of_level(level: GameLevel, drives: Sequence[RecordedDrive], is_open: bool) -> LevelProgress:
    best: dict[DriverKind, float] = {}
    medals: dict[DriverKind, Medal] = {}
    rules: frozenset[ExtraRule] = frozenset()
    stars = [False] * STAR_COUNT
    for drive in drives:
        if drive.edition < EDITION:
            stars = [had or has for had, has in zip(stars, drive.finish.earned_stars(level.par), strict=True)]
        elif drive.finish.reached and not drive.is_shipped:
            driver = drive.driver
            best[driver] = min(best.get(driver, float("inf")), drive.finish.seconds)
            medals[driver] = max(medals.get(driver, Medal.NONE), drive.medal)
            rules |= drive.rules
    first_edition = stars[0], stars[1], stars[2]
    return LevelProgress(
        level, is_open or bool(best) or stars[0], medals, rules, first_edition, best, len(drives)
    )
