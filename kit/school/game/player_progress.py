"""A player's medals, stars and progress in the levels, and the daily challenge, computed from the journal."""

from __future__ import annotations

import ast
import contextlib
import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Final

from kit.controllers import kit_controllers
from kit.school.game.league.house import house_programs
from kit.school.game.levels import (
    CHALLENGES_WORLD,
    GameLevel,
    all_worlds,
)
from kit.school.game.medal import Medal
from kit.school.game.race import DriverKind, RaceFinish
from kit.school.lessons.catalogue import lesson_progress_from_events
from kit.school.lessons.reading import find_lesson
from kit.school.progress import EventKind, ProgressEvent
from kit.world.problems import WorldError


class ExtraRule(StrEnum):
    """A rule that nobody has to keep; each earns one star on each level."""

    CLEAN = "clean"
    NO_STOP = "no stop"
    ONE_SENSOR = "one sensor"
    FEW_LINES = "few lines"
    FEW_STEPS = "few steps"

    def description(self, level: GameLevel) -> str:
        """The rule in words, with the level's limits."""
        return {
            ExtraRule.CLEAN: "no bump",
            ExtraRule.NO_STOP: "no stop on the way",
            ExtraRule.ONE_SENSOR: "a program or agent that listens to one sensor",
            ExtraRule.FEW_LINES: f"a program of at most {level.rules.max_lines} lines of code",
            ExtraRule.FEW_STEPS: f"an agent of at most {level.rules.max_training_steps or 0:,} training steps",
        }[self]

    def short_name(self, level: GameLevel) -> str:
        """The same in a few words."""
        return {
            ExtraRule.CLEAN: "no bump",
            ExtraRule.NO_STOP: "no stop",
            ExtraRule.ONE_SENSOR: "one sensor",
            ExtraRule.FEW_LINES: f"{level.rules.max_lines} lines",
            ExtraRule.FEW_STEPS: f"{level.rules.max_training_steps or 0:,} training steps",
        }[self]


@dataclass(frozen=True, slots=True)
class DriverFacts:
    """What counts about who drove, beside the drive."""

    is_shipped: bool = False
    """Whether it is one of the kit's own controllers, or a copy of one: its drives earn nothing."""
    code_lines: int | None = None
    """Lines of code of the program; None for any other driver."""
    training_steps: int | None = None
    """The agent's training steps; None for any other driver."""


BY_HAND: Final = DriverFacts()


def offered_rules(level: GameLevel) -> tuple[ExtraRule, ...]:
    """The rules that earn stars on a level."""
    is_for_agents = level.rules.max_training_steps is not None
    return tuple(rule for rule in ExtraRule if is_for_agents or rule is not ExtraRule.FEW_STEPS)


def kept_rules(level: GameLevel, finish: RaceFinish, facts: DriverFacts) -> tuple[ExtraRule, ...]:
    """The extra rules that a drive kept; none where it did not reach the goal."""
    if not finish.reached or facts.is_shipped:
        return ()
    kept = {
        ExtraRule.CLEAN: finish.collisions == 0,
        ExtraRule.NO_STOP: not finish.has_stopped,
        ExtraRule.ONE_SENSOR: finish.sensors is not None and finish.sensors <= 1,
        ExtraRule.FEW_LINES: facts.code_lines is not None and facts.code_lines <= level.rules.max_lines,
        ExtraRule.FEW_STEPS: facts.training_steps is not None
        and level.rules.max_training_steps is not None
        and facts.training_steps <= level.rules.max_training_steps,
    }
    return tuple(rule for rule in ExtraRule if kept[rule])


def facts_of_program(file: Path) -> DriverFacts:
    """The facts that a program's file shows."""
    try:
        text = bare_code(file.read_bytes())
    except (OSError, *CODE_ERRORS):
        return DriverFacts()  # it cannot drive either, and says so itself
    programs = [*(each.file.read_bytes() for each in kit_controllers()), *house_programs().values()]
    shipped = set(map(bare_code, programs))
    return DriverFacts(is_shipped=text in shipped, code_lines=len(text.splitlines()) - text.count("\n\n"))


CODE_ERRORS: Final = (SyntaxError, ValueError, RecursionError, MemoryError)
"""What reading a text as a program raises that is none."""


def bare_code(source: bytes) -> str:
    """A program without comments, docstrings and other constants that stand alone, in Python's own layout. Raises ``CODE_ERRORS``."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        for field, value in ast.iter_fields(node):
            if isinstance(value, list) and value and isinstance(value[0], ast.stmt):
                does = [each for each in value if not _is_constant(each)]
                setattr(node, field, does or ([ast.Pass()] if field == "body" else []))
    return ast.unparse(tree)


def _is_constant(statement: ast.stmt) -> bool:
    """Whether it does nothing, as a docstring."""
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


@dataclass(frozen=True, slots=True)
class Belt:
    """What is earned in a world by medals on its levels."""

    name: str
    medal: Medal
    """On so many levels, or a better one."""
    share: float
    """Of the levels; at least one."""
    task: str

    def least(self, levels: int) -> int:
        """On how many of so many levels."""
        return max(1, math.ceil(self.share * levels))


BELTS: Final = (
    Belt("white", Medal.BRONZE, 0.0, "a medal"),
    Belt("yellow", Medal.BRONZE, 1.0, "a medal on each level"),
    Belt("green", Medal.SILVER, 0.5, "silver on half of the levels"),
    Belt("blue", Medal.SILVER, 1.0, "silver on each level"),
    Belt("brown", Medal.GOLD, 0.5, "gold on half of the levels"),
    Belt("black", Medal.GOLD, 1.0, "gold on each level"),
)


@dataclass(frozen=True, slots=True)
class LevelProgress:
    """The player's progress in one level."""

    level: GameLevel
    is_open: bool
    medals: Mapping[DriverKind, Medal]
    """The best medal of each driver that has one."""
    rules: frozenset[ExtraRule]
    """Extra rules that a drive has kept: a star each."""
    best_times: Mapping[DriverKind, float]
    """The shortest time [s] of each driver that counts for medals."""

    @property
    def best_medal(self) -> Medal:
        return max(self.medals.values(), default=Medal.NONE)

    @property
    def best_driver(self) -> DriverKind:
        """The driver with the best medal, else one that has arrived, else by hand."""
        return max(DriverKind, key=lambda kind: (self.medals.get(kind, -1), kind in self.best_times))

    @property
    def star_count(self) -> int:
        """Stars of extra rules."""
        return len(self.rules)


@dataclass(frozen=True, slots=True)
class RecordedDrive:
    """A drive of a level, as the journal has it."""

    driver: DriverKind
    finish: RaceFinish
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
            level.is_open_at_first
            or level.opened_by_lesson in lessons
            or any(each in reached for each in level.opened_by),
        )
        for level in levels
    )


def belt_of(best: Sequence[Medal]) -> str:
    """The belt of a world, by the best medal on each of its levels: the last of ``BELTS`` that is earned with all before it."""
    earned = _belts_earned(best)
    return BELTS[earned - 1].name if earned else "no"


def next_belt(best: Sequence[Medal]) -> Belt | None:
    """The belt that is to be earned next; None where all are."""
    return next(iter(BELTS[_belts_earned(best) :]), None)


def _belts_earned(best: Sequence[Medal]) -> int:
    earned = [sum(medal >= each.medal for medal in best) >= each.least(len(best)) for each in BELTS]
    return (*earned, False).index(False)


@dataclass(frozen=True, slots=True)
class GameSummary:
    """All that a player has won."""

    levels: Sequence[LevelProgress]
    challenges: Sequence[Medal]
    """The best medal of each challenge."""

    def count(self, wanted: Medal) -> int:
        """How many medals of one kind there are: of each level one by each driver, and of each challenge one."""
        medals = (*self.challenges, *(medal for each in self.levels for medal in each.medals.values()))
        return sum(medal is wanted for medal in medals)

    @property
    def stars(self) -> int:
        """Number of stars for extra rules."""
        return sum(each.star_count for each in self.levels)

    @property
    def best_by_world(self) -> dict[str, tuple[Medal, ...]]:
        """The best medal of each level, or challenge, of each world, by the world's title."""
        best = {
            world.title: tuple(each.best_medal for each in self.levels if each.level.world == world.id)
            for world in all_worlds()
        }
        return {**best, CHALLENGES_WORLD.title: tuple(self.challenges)}


def open_level_after(progress: Sequence[LevelProgress], level: GameLevel) -> GameLevel | None:
    """The next of all levels that is open; None after the last one, and for one that is none of them, as a day's."""
    levels = [each.level for each in progress]
    later = progress[levels.index(level) + 1 :] if level in levels else ()
    return next((each.level for each in later if each.is_open), None)


def is_best_drive(progress: LevelProgress, driver: DriverKind, finish: RaceFinish) -> bool:
    """Whether a drive is the driver's best one so far."""
    return finish.reached and finish.seconds < progress.best_times.get(driver, float("inf"))


def _progress_of_level(level: GameLevel, drives: Sequence[RecordedDrive], is_open: bool) -> LevelProgress:
    best: dict[DriverKind, float] = {}
    medals: dict[DriverKind, Medal] = {}
    rules: frozenset[ExtraRule] = frozenset()
    for drive in drives:
        if drive.finish.reached and not drive.is_shipped:
            driver = drive.driver
            best[driver] = min(best.get(driver, float("inf")), drive.finish.seconds)
            medals[driver] = max(medals.get(driver, Medal.NONE), drive.medal)
            rules |= drive.rules
    return LevelProgress(level, is_open or bool(best), medals, rules, best)
