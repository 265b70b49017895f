"""Reads the game's levels and their worlds: map, goal, what opens each, and the conditions that differ from the map's."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final, Literal

from kit.learning.tasks.disturbances import TURN_SHARE
from kit.learning.tasks.goals.goal import Goal
from kit.learning.tasks.goals.registry import read_goal
from kit.learning.tasks.goals.target import REACH_TARGET
from kit.plain_text import quoted, suggestion, unknown_name
from kit.run.scenario import Scenario, find_scenario
from kit.school.game.drive_commands import ReferenceDrive
from kit.school.lessons.reading import lesson_number, lessons_folder
from kit.sim.card_world import with_carts
from kit.sim.motors import SpeedLimits
from kit.sim.plugins.diff_drive import DiffDriveParams
from kit.sim.plugins.tricycle_drive import TricycleDriveParams
from kit.world.catalogue import MapCard, MovingCart, find_map, read_carts
from kit.world.documents import open_document
from kit.world.problems import WorldError
from kit.world.records import PluginSpec
from kit.world.yaml_section import Section

SPEED: Final = 0.5
"""What the robot's motors give on a level, and what its keys ask for [m/s]."""
TURN_RATE: Final = 1.5
"""[rad/s]"""
PAIR_SPEED: Final = 0.52
"""The same for each of two wheelchairs: the outer one drives faster than the point between them [m/s]."""


@dataclass(frozen=True, slots=True)
class LevelConditions:
    """What differs on a level from its map."""

    acceleration: float = 0.0
    """Greatest change of speed [m/s^2], as on ice; ``TURN_SHARE`` times as many rad/s^2 of turning. 0: none."""
    wheel_error: float = 0.0
    """The encoders' wheels differ by this share from what they are taken for; 0: odometry is exact."""
    fog: bool = False
    """Whether only what the laser has seen is drawn, and the target only once the robot is near."""
    charge: float = 0.0
    """Distance that one charge of the battery lasts [m]; 0: for ever."""
    docks: tuple[tuple[float, float], ...] = ()
    """Where standing still recharges the battery [m, m]."""
    carts: tuple[MovingCart, ...] = ()


UNCHANGED: Final = LevelConditions()


def apply_conditions(
    scenario: Scenario, conditions: LevelConditions, motors: tuple[float, float] | None = None
) -> Scenario:
    """The scenario under a level's conditions. ``motors``: the speed [m/s] and turn rate [rad/s] that they give; by
    default those of the kit's levels. Raises WorldError."""
    world = scenario.world
    driven = set(scenario.partners)
    limits = motors or (PAIR_SPEED if len(driven) > 1 else SPEED, TURN_RATE)
    models = [
        replace(model, plugins=tuple(_limit_drive(each, conditions, limits) for each in model.plugins))
        if model.name in driven
        else model
        for model in world.models
    ]
    return replace(scenario, world=with_carts(replace(world, models=tuple(models)), conditions.carts))


def _limit_drive(plugin: PluginSpec, conditions: LevelConditions, motors: tuple[float, float]) -> PluginSpec:
    """A drive's plugin with the level's motors and odometry; any other as it is."""
    params = plugin.params
    if not isinstance(params, DiffDriveParams | TricycleDriveParams):
        return plugin
    acceleration = conditions.acceleration
    odometry = params.odometry
    if conditions.wheel_error:
        odometry = replace(odometry, use_encoders=True, wheel_error=conditions.wheel_error)
    top_speed, turn_rate = motors
    linear = SpeedLimits(acceleration, acceleration, top_speed)
    if isinstance(params, TricycleDriveParams):
        return replace(plugin, params=replace(params, linear=linear, odometry=odometry))
    angular = SpeedLimits(TURN_SHARE * acceleration, TURN_SHARE * acceleration, turn_rate)
    return replace(plugin, params=replace(params, linear=linear, angular=angular, odometry=odometry))


LEVELS_FILE: Final = "levels.yaml"
MAX_LINES: Final = 30
MAX_TRAINING_STEPS: Final = 41_000
"""PPO trains in batches: its ``--steps 40000`` are 40,960."""


class UnknownLevel(LookupError):
    """No level has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class GameWorld:
    """A group of levels."""

    id: str
    title: str
    story: str
    """One sentence."""


CHALLENGES_WORLD: Final = GameWorld(
    "challenges", "Puzzles", "Not all work is driving: plans, rewards, budgets, other people's code."
)
"""Of the levels' list: all challenges."""


@dataclass(frozen=True, slots=True)
class ExtraRules:
    """The limits of a level's extra rules; each that is kept earns one star."""

    max_lines: int = MAX_LINES
    """Lines of code of a program, without comments and docstrings."""
    max_training_steps: int | None = MAX_TRAINING_STEPS
    """None: no agent is trained for it, as in a day."""


@dataclass(frozen=True, slots=True)
class GameLevel:
    """One level that is driven."""

    id: str
    title: str
    map_name: str
    """Name of a map of the kit; of a task's level, of the task's map."""
    case: str
    hint: str
    opened_by: tuple[str, ...]
    """Ids of levels; finishing any of them opens this one."""
    row: int
    """The smallest number of levels before it."""
    is_open_at_first: bool = True
    """Whether it is open from the start: nothing opens it, or it is the first of its world."""
    world: str = ""
    """Id of its world."""
    story: str = ""
    """Who needs this drive, and why: two rows of a small screen."""
    ending: str = ""
    """What came of it, told once the goal is reached; as long at most, or empty."""
    skill: str = ""
    """The skill without which it is not finished."""
    opened_by_lesson: str = ""
    """Name of the lesson that prepares it and opens it too, ``01-drive``; may be empty."""
    time_limit: float = 60.0
    """A drive ends after this time [s]."""
    goal: Goal = REACH_TARGET
    targets: tuple[tuple[float, float], ...] = ()
    """Those of a route [m, m]."""
    any_order: bool = False
    """Whether the targets may be reached in any order."""
    leader: str = ""
    """The model that is the target, where that moves."""
    abreast: float = 0.0
    """The share of a drive for which two robots must be side by side to earn more than bronze; 0: it does not matter."""
    measured_to: Literal["hull", "axle"] = "hull"
    """What of a robot must be in the target."""
    reference: str = ""
    """The level whose reference drive is this one's too; empty: it has its own."""
    drive: ReferenceDrive | None = None
    """Its reference drive, where that is not in the file of all."""
    conditions: LevelConditions = UNCHANGED
    rules: ExtraRules = ExtraRules()

    @property
    def skill_sentence(self) -> str:
        """The skill without which it is not finished; empty where none is known."""
        return f"It takes {self.skill}." if self.skill else ""

    @property
    def lesson_number(self) -> str:
        """The number of the lesson that opens it, ``A2``; empty for none."""
        return lesson_number(self.opened_by_lesson) if self.opened_by_lesson else ""

    @property
    def reference_id(self) -> str:
        """The level that its reference drive belongs to."""
        return self.reference or self.id

    @property
    def has_medals(self) -> bool:
        """Whether its drives can earn medals and stars."""
        return True

    @property
    def command_name(self) -> str:
        """What the verbs of ``kit game`` take for it."""
        return self.id

    @property
    def map_card(self) -> MapCard:
        """The card of its map. Raises UnknownMap."""
        return find_map(self.map_name)

    def find_scenario(self) -> Scenario:
        """Loads the scenario that is driven, under the level's conditions. Raises LookupError and WorldError."""
        scenario = find_scenario(self.map_name, self.case, None)
        scenario = replace(scenario, level=self.id, leader=self.leader or None)
        if self.targets and scenario.case is not None:
            first = replace(scenario.case, target=self.targets[0])
            scenario = replace(scenario, case=first, targets=self.goal.route(self.targets))
        return apply_conditions(scenario, self.conditions)


def all_levels(folder: Path | None = None) -> tuple[GameLevel, ...]:
    """Reads all levels in order. Raises WorldError with all mistakes of the file."""
    return (_read_kit_file() if folder is None else _read_file(folder))[1]


def all_worlds() -> tuple[GameWorld, ...]:
    """Reads the worlds that the levels belong to, in order. Raises WorldError likewise."""
    return _read_kit_file()[0]


def levels_of_lesson(name: str) -> tuple[GameLevel, ...]:
    """The levels that a lesson opens. ``name``: of the lesson, ``01-drive``."""
    return tuple(each for each in all_levels() if each.opened_by_lesson == name)


def opened_levels_text(levels: tuple[GameLevel, ...]) -> str:
    """What the end of a lesson says of the levels that it opens; empty for none."""
    if not levels:
        return ""
    if len(levels) == 1:
        return (
            f"It opens the level {levels[0].title} of the game. To drive it: `kit game play {levels[0].id}`"
        )
    titles = ", ".join(level.title for level in levels[:-1])
    return f"It opens the levels {titles} and {levels[-1].title} of the game: `kit game`"


def find_level(name: str) -> GameLevel:
    """Finds a level by its id, its title or its number, counted from 1. Raises UnknownLevel."""
    levels = all_levels()
    for number, level in enumerate(levels, 1):
        if name.casefold() in (level.id, level.title.casefold(), str(number)):
            return level
    ids = [level.id for level in levels]
    raise UnknownLevel(unknown_name("level", name, ids, "kit game"))


@cache
def _read_kit_file() -> tuple[tuple[GameWorld, ...], tuple[GameLevel, ...]]:
    return _read_file(lessons_folder())


def _read_file(folder: Path) -> tuple[tuple[GameWorld, ...], tuple[GameLevel, ...]]:
    with open_document(folder / LEVELS_FILE) as section:
        worlds = tuple(_read_worlds(section))
        levels = tuple(_read_levels(section, {world.id: world for world in worlds}))
    return worlds, levels


def _read_worlds(section: Section) -> Iterator[GameWorld]:
    for each in section.sections("worlds", ()):
        yield GameWorld(each.name("id"), each.name("title"), each.text("story"))
        each.finish()


def _read_levels(section: Section, worlds: Mapping[str, GameWorld]) -> Iterator[GameLevel]:
    rows: dict[str, int] = {}
    begun: set[str] = set()
    for each in section.sections("levels", at_least=1):
        identity = each.name("id")
        after = each.texts("after", ())
        for before in after:
            if before not in rows:
                each.error(
                    f"there is no level {quoted(before)} before this one: {suggestion(before, tuple(rows))}",
                    "after",
                )
        row = 1 + max((rows.get(before, 0) for before in after), default=-1)
        if identity in rows:
            each.error(f"a level {quoted(identity)} exists already", "id")
        rows[identity] = row
        level = _read_level(each, identity, after, row)
        level = replace(level, is_open_at_first=not after or level.world not in begun)
        begun.add(level.world)
        if level.world not in worlds:
            each.error(
                f"there is no world {quoted(level.world)}: {suggestion(level.world, tuple(worlds))}", "world"
            )
        each.finish()
        try:
            level.find_scenario()
        except (LookupError, WorldError) as error:
            each.error(str(error), "place")
            continue
        yield level


def _read_level(each: Section, identity: str, after: tuple[str, ...], row: int) -> GameLevel:
    targets = each.points("targets", at_least=1) if each.has("targets") else ()
    leader, goal = each.text("leader", ""), read_goal(each.section("goal", None))
    _check_goal(each, goal, targets, leader)
    abreast = each.number("abreast", 0.0, minimum=0, maximum=1)
    hint = each.text("hint")
    if abreast:
        hint = f"{hint.removesuffix('.')}; side by side {100.0 * abreast:g} % of the time."
    return GameLevel(
        id=identity,
        title=each.name("title"),
        map_name=each.name("place"),
        case=each.name("case"),
        hint=hint,
        opened_by=after,
        row=row,
        world=each.name("world"),
        story=each.text("story"),
        ending=each.text("ending"),
        skill=each.text("skill"),
        opened_by_lesson=each.text("lesson", ""),
        time_limit=each.number("time_limit", 60.0, above=0, maximum=3600),
        goal=goal,
        targets=targets,
        any_order=each.flag("any_order", False),
        leader=leader,
        abreast=abreast,
        conditions=_read_conditions(each),
        rules=ExtraRules(
            each.integer("max_lines", MAX_LINES, minimum=1, maximum=1000),
            each.integer("max_training_steps", MAX_TRAINING_STEPS, minimum=1, maximum=10**9),
        ),
    )


def _check_goal(each: Section, goal: Goal, targets: tuple[tuple[float, float], ...], leader: str) -> None:
    """Notes what a level's goal needs and the level does not give, or the other way round."""
    for needs, given, key, what in (
        (goal.is_route, bool(targets), "targets", "a list of points"),
        (goal.needs_leader, bool(leader), "leader", "a model that moves"),
    ):
        if needs and not given:
            each.error(f'the goal {goal.kind} needs "{key}": {what}', "goal")
        if given and not needs:
            each.error(f'the goal {goal.kind} has no "{key}"', key)


def _read_conditions(each: Section) -> LevelConditions:
    return LevelConditions(
        acceleration=each.number("acceleration", 0.0, minimum=0),
        wheel_error=each.number("wheel_error", 0.0, minimum=0, maximum=0.5),
        fog=each.flag("fog", False),
        charge=each.number("charge", 0.0, minimum=0),
        docks=each.points("docks") if each.has("docks") else (),
        carts=read_carts(each),
    )
