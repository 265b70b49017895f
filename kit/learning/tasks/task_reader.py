"""Reads task files: every error at once, each with its file, line and column.

The keys are described in ``README.md`` beside this file; ``hallway.yaml`` and its neighbours are examples.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Literal

from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.actions import MAX_SPEED, MAX_TURN_RATE, Actions, ContinuousActions, DiscreteActions
from kit.learning.tasks.case_reader import CaseReader, PlacedCase
from kit.learning.tasks.curriculum import read_curriculum
from kit.learning.tasks.disturbances import UNDISTURBED, DisturbanceError, Disturbances
from kit.learning.tasks.goals.registry import read_goal
from kit.learning.tasks.learning_task import PRESET_NAMES, Ending, LearningTask, StartVariation
from kit.learning.tasks.observations import PART_NAMES, ObservationSpec
from kit.learning.tasks.reward import Reward, TermWeight, UnknownRewardTerm
from kit.learning.tasks.reward_terms import TERMS, term_settings
from kit.learning.tasks.rewards import REWARDS
from kit.plain_files import is_file_there
from kit.plain_text import quoted, suggestion
from kit.world.catalogue import WORLD_FILE, MapCard, UnknownMap, allowed_root_of, find_map, read_carts
from kit.world.documents import MAX_YAML_BYTES, AllowedRoot, UnusableFile, WorldDocuments, read_text
from kit.world.problems import Problem, ProblemCollector, WorldError
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section

TASK_FILE = "task.yaml"
MAX_STEPS = 100_000
MAX_ROBOTS = 4
MAX_SECTORS = RAY_COUNT
MAX_ACTIONS = 64
"""Most actions of one robot."""
MAX_FRAMES = 16
SUCCESS_REWARD = Reward("success", (TermWeight("reached", 1.0),), is_small=True)
"""What tests count for a task whose reward is a file."""
ENDINGS: Mapping[str, Ending] = MappingProxyType(
    {"terminated": "terminated", "truncated": "truncated", "continues": "continues"}
)
FINAL_ENDINGS: Mapping[str, Literal["terminated", "truncated"]] = MappingProxyType(
    {"terminated": "terminated", "truncated": "truncated"}
)


@dataclass(frozen=True, slots=True)
class ReadTask:
    """A task as its file says, and where in the file its cases stand."""

    task: LearningTask
    text: str
    cases: tuple[PlacedCase, ...]
    section: Section
    """The whole file; takes what is found to be wrong later."""
    problems: ProblemCollector
    """What has been found to be wrong so far."""


def read_task(file: Path, text: str | None = None) -> ReadTask:
    """Reads a task's file. ``text``: what it held, where it is not to be read again.

    WorldError if something in it is wrong, with all errors and their places.
    """
    try:
        content = read_text(file, MAX_YAML_BYTES) if text is None else text
    except UnusableFile as error:
        raise WorldError([Problem(SourceLocation(file), f"cannot be read: {error}")]) from None
    documents = WorldDocuments(AllowedRoot.of_folder(file.parent), {}, ProblemCollector())
    with documents.open(file, content) as section:
        reader = _TaskReader(section, file, content, documents.allowed_root, is_kept=text is not None)
        task, cases = reader.read()
    return ReadTask(task, content, cases, section, documents.problems)


def task_name(file: Path) -> str:
    """The name of a task: that of its file, or of the folder of a ``task.yaml``."""
    return file.absolute().parent.name if file.name == TASK_FILE else file.stem


def _named_in(file: Path, key: str, within: str | None = None) -> str | None:
    """Returns what a task's file names now by ``key``, perhaps ``within`` a part; None if there is no such file, or it names
    nothing."""
    try:
        documents = WorldDocuments(AllowedRoot.of_folder(file.parent), {}, ProblemCollector())
        section = documents.section(file, SourceLocation(file))
        if section is not None and within is not None:
            section = section.section(within) if section.is_mapping(within) else None
        return section.name(key) if section is not None and section.has(key) else None
    except (UnusableFile, WorldError):
        return None


class _TaskReader:
    """Reads one file's mapping."""

    def __init__(self, section: Section, file: Path, text: str, root: AllowedRoot, *, is_kept: bool) -> None:
        """``is_kept``: the text comes from elsewhere, such as a policy of somebody else's, and may name any file."""
        self._section = section
        self._file = file
        self._text = text
        self._root = root
        self._is_kept = is_kept

    def read(self) -> tuple[LearningTask, tuple[PlacedCase, ...]]:
        """The task and its cases. What is wrong is noted, and something else stands in its place."""
        section = self._section
        summary = section.name("summary", "")
        maps, cards = self._maps()
        robot_names = self._robot_names(cards)
        robots = len(robot_names) or (1 if not cards or cards[0].partner is None else 2)
        goal = read_goal(section.section("goal", None))
        if robots < goal.least_robots:
            section.error(
                f"the goal {goal.kind} needs {goal.least_robots} robots, and here drives {robots}", "goal"
            )
        cases = CaseReader(cards, robots, goal).read(section)
        reward, reward_file = self._reward(section.section("reward"))
        step, target = section.section("step", None), section.section("target", None)
        task = LearningTask(
            task_name(self._file),
            summary,
            maps,
            robots,
            actions=_read_actions(section.section("actions")),
            observation=_read_observation(section.section("observation"), robots),
            reward=reward,
            reward_file=reward_file,
            cases=section.texts("on", ()),
            cards=cards if any(each.carts for each in cards) or section.has("world_file") or not maps else (),
            own_cases=tuple((case.map_number, case.case) for case in cases),
            robot_names=robot_names,
            start=_read_start(section.section("start", None)),
            goal=goal,
            preset=section.text("preset", "", choices=PRESET_NAMES),
            success=section.number("success", above=0, maximum=1) if section.has("success") else None,
            lidar_noise=section.number("lidar_noise", minimum=0) if section.has("lidar_noise") else None,
            disturbances=_read_disturbances(section.section("disturbances", None)),
            random_phase=section.text("moving_models", "anywhere", choices=("anywhere", "as in their files"))
            == "anywhere",
            file=self._file,
            version=hashlib.sha256(self._text.encode()).hexdigest()[:12],
        )
        task = _with_step(_with_target(task, target), step)
        task = _with_endings(task, section.section("endings", None))
        stages = section.sections("curriculum", ())
        return replace(task, curriculum=read_curriculum(stages, _case_names(cards, cases))), cases

    # Parts that name files

    def _maps(self) -> tuple[tuple[str, ...], tuple[MapCard, ...]]:
        """The names of the kit's maps, or none for a world of the task's own; and their cards."""
        section = self._section
        if section.has("world"):
            if section.has("maps"):
                section.error("a task uses maps of the kit or its own world, not both", "maps")
            return (), self._own_world()
        carts = read_carts(section)
        names = section.texts("maps", at_least=1)
        world_file = section.text("world_file", WORLD_FILE)
        cards = []
        for name in names:
            try:
                card = find_map(name)
                file = AllowedRoot.of_folder(card.folder).resolve(world_file, card.folder)
                cards.append(replace(card, world_file=file, carts=carts))
                if not is_file_there(file):
                    section.error(f"the map {name} has no file {quoted(world_file)}", "world_file")
            except UnknownMap as error:
                section.error(f"{error} For a file of your own write world: FILE", "maps")
            except UnusableFile as error:
                section.error(str(error), "world_file")
        return names, tuple(cards)

    def _own_world(self) -> tuple[MapCard, ...]:
        section, name = self._section, self._section.name("world")
        if self._is_kept and name != _named_in(self._file, "world"):
            section.error(
                f"its world is not here: there is no task {quoted(str(self._file), 200)} that names {quoted(name)}. "
                "Choose another task, such as one of the kit's",
                "world",
            )
            return ()
        try:
            file = self._root.resolve(name, self._file.parent)
        except UnusableFile as error:
            section.error(str(error), "world")
            return ()
        if is_file_there(file / "world.yaml"):
            file /= "world.yaml"
        if not is_file_there(file):
            section.error(f"there is no file {quoted(str(file), 200)}", "world")
            return ()
        names = section.names("robots") if section.has("robots") else ("serp",)
        title = task_name(self._file)
        own_root = allowed_root_of(file)
        card = MapCard(title, title, "", "", file.parent, file, names[0], None, (), own_root or file.parent)
        return (card,)

    def _robot_names(self, cards: tuple[MapCard, ...]) -> tuple[str, ...]:
        section = self._section
        if not section.has("robots"):
            return () if not cards or cards[0].cases else (cards[0].robot,)
        names = section.names("robots")
        if len(names) > MAX_ROBOTS:
            section.error(f"at most {MAX_ROBOTS} robots learn together, not {len(names)}", "robots")
        if len(set(names)) < len(names):
            section.error("a robot is named twice", "robots")
        return names

    def _reward(self, section: Section) -> tuple[Reward, Path | None]:
        scale = section.number("scale", 1.0)
        if section.has("file"):
            name = section.name("file")
            section.finish()
            if self._is_kept and name != _named_in(self._file, "file", "reward"):
                section.error(
                    f"its reward is not here: there is no task {quoted(str(self._file), 200)} that names {quoted(name)}. "
                    "Choose another task, such as one of the kit's",
                    "file",
                )
                return SUCCESS_REWARD, None
            try:
                file = self._root.resolve(name, self._file.parent)
            except UnusableFile as error:
                section.error(str(error), "file")
                return SUCCESS_REWARD, None
            if not is_file_there(file):
                section.error(f"there is no file {quoted(str(file), 200)}", "file")
            return SUCCESS_REWARD, file
        if section.has("name"):
            reward = section.choice("name", REWARDS)
            section.finish()
            return SUCCESS_REWARD if reward is None else replace(reward, scale=scale), None
        weights = _read_weights(section.section("terms"))
        section.finish()
        return Reward(task_name(self._file), weights, scale, is_small=True), None


def _case_names(cards: tuple[MapCard, ...], cases: tuple[PlacedCase, ...]) -> list[tuple[str, str]]:
    """The name and group of each case."""
    own = [(case.case.name, case.case.group) for case in cases]
    return own or [(case.name, case.group) for card in cards for case in card.cases]


# Parts that stand for themselves


def _read_weights(section: Section) -> tuple[TermWeight, ...]:
    weights = []
    for term in section.keys():  # noqa: SIM118 - a Section is no mapping
        if term not in TERMS:
            section.error(
                f"there is no reward term {quoted(term)}: {suggestion(term, TERMS)} "
                f"There are: {', '.join(TERMS)}.",
                term,
            )
            section.has(term)
            continue
        weights.append(_read_weight(section, term))
    section.finish()
    if not weights:
        section.error("a reward needs at least one term")
    return tuple(weights)


def _read_weight(section: Section, term: str) -> TermWeight:
    if not section.is_mapping(term):
        return TermWeight(term, section.number(term))
    inner = section.section(term)
    known = term_settings(term)
    weight, at_end = inner.number("weight"), inner.flag("at_end", True)
    settings = tuple((name, inner.number(name)) for name in known if inner.has(name))
    inner.finish()
    try:
        return TermWeight(term, weight, at_end, settings)
    except UnknownRewardTerm as error:  # cannot be: the names are the term's own
        inner.error(str(error))
        return TermWeight(term, weight)


def _read_actions(section: Section) -> Actions:
    if section.has("linear") or section.has("angular"):
        linear, angular = (
            _read_range(section, "linear", MAX_SPEED),
            _read_range(section, "angular", MAX_TURN_RATE),
        )
        section.finish()
        return ContinuousActions(linear, angular)
    table = section.section("twists")
    names = table.keys()
    twists = tuple(table.point(name) for name in names)
    table.finish()
    for name, (speed, turn) in zip(names, twists, strict=True):
        if abs(speed) > MAX_SPEED or abs(turn) > MAX_TURN_RATE:
            table.error(
                f"{quoted(name)} must be [m/s, rad/s] of at most {MAX_SPEED:g} and {MAX_TURN_RATE:g}", name
            )
    if not 2 <= len(names) <= MAX_ACTIONS:
        table.error(f"there must be 2 to {MAX_ACTIONS} actions to choose from, not {len(names)}")
    one_number = section.flag("one_number", True)
    section.finish()
    return DiscreteActions(names or ("stop",), twists or ((0.0, 0.0),), one_number)


def _read_range(section: Section, key: str, most: float) -> tuple[float, float]:
    low, high = section.point(key)
    if section.has(key) and not -most <= low < high <= most:
        section.error(f"{quoted(key)} must be [least, greatest], between {-most:g} and {most:g}", key)
        return 0.0, most
    return low, high


def _read_observation(section: Section, robots: int) -> ObservationSpec:
    flags = {name: section.flag(name, False) for name in PART_NAMES}
    side_rays = section.flag("side_rays", False)
    if side_rays and robots != 2:
        section.error(f"side_rays need two robots; this task has {robots}", "side_rays")
        side_rays = False
    found = ObservationSpec(
        rays=section.integers("rays", (), minimum=0, maximum=RAY_COUNT - 1),
        sectors=_read_sectors(section),
        side_rays=side_rays,
        clip=section.number("clip", 2.0, above=0, maximum=100),
        scale=section.number("scale", 1.0, above=0, maximum=1000),
        frames=section.integer("frames", 1, minimum=1, maximum=MAX_FRAMES),
        other_rays=section.integers("other_rays", (), minimum=0, maximum=RAY_COUNT - 1),
        **flags,
    )
    if found.other_rays and (robots == 1 or len(found.other_rays) != len(found.rays)):
        section.error(
            f"other_rays are those of every robot but the first, {len(found.rays)} as for that one",
            "other_rays",
        )
        found = replace(found, other_rays=())
    section.finish()
    if not found.frame_size:
        section.error("an agent needs observations: give rays, sectors or others")
        return replace(found, rays=(0,))
    return found


def _read_sectors(section: Section) -> tuple[int, ...]:
    """(91): a number of equal sectors, or how many rays each one has."""
    if not section.has("sectors"):
        return ()
    if not section.is_list("sectors"):
        count = section.integer("sectors", minimum=1, maximum=MAX_SECTORS)
        return tuple(ray * count // RAY_COUNT for ray in range(RAY_COUNT))
    sizes = section.integers("sectors", minimum=1, maximum=RAY_COUNT, at_least=1)
    if sum(sizes) != RAY_COUNT:
        section.error(
            f"the sectors have {sum(sizes)} rays, but the lidar has {RAY_COUNT}: from straight behind over the right, "
            "ahead and the left back to straight behind",
            "sectors",
        )
        return ()
    numbers = [number for number, size in enumerate(sizes) for _ in range(size)]
    if section.flag("sectors_join_behind", False):
        numbers = [0 if number == len(sizes) - 1 else number for number in numbers]
    return tuple(numbers)


def _read_start(section: Section | None) -> StartVariation:
    if section is None:
        return StartVariation()
    found = StartVariation(
        section.flag("shifted", True),
        section.number("noise", 0.0, minimum=0),
        section.number("max_rotation", 0.0, minimum=0, maximum=math.pi),
        section.number("gap", above=0) if section.has("gap") else None,
    )
    section.finish()
    return found


def _with_target(task: LearningTask, section: Section | None) -> LearningTask:
    if section is None:
        return task
    measures: Mapping[str, Literal["hull", "axle"]] = {"hull": "hull", "axle": "axle"}
    task = replace(
        task,
        target_radius=section.number("radius", task.target_radius, above=0),
        measured_to=section.choice("measured_to", measures, "hull"),
        path_end=section.number("path_end", 0.0, minimum=0),
    )
    section.finish()
    return task


def _with_step(task: LearningTask, section: Section | None) -> LearningTask:
    if section is None:
        return task
    task = replace(
        task,
        step_time=section.number("time", task.step_time, minimum=0.01, maximum=10),
        collision_checks=section.integer("collision_checks", task.collision_checks, minimum=1, maximum=100),
        max_steps=section.integer("limit", task.max_steps, minimum=1, maximum=MAX_STEPS),
        stops_between=section.flag("stops_between", False),
    )
    section.finish()
    return task


def _with_endings(task: LearningTask, section: Section | None) -> LearningTask:
    if section is None:
        return task
    task = replace(
        task,
        collision_ending=section.choice("collision", ENDINGS, "terminated"),
        goal_ending=section.choice("goal", FINAL_ENDINGS, "terminated"),
        timeout_terminal=section.choice("time", FINAL_ENDINGS, "truncated") == "terminated",
    )
    section.finish()
    return task


def _read_disturbances(section: Section | None) -> Disturbances:
    if section is None:
        return UNDISTURBED
    found = {}
    for name, value in section.remaining_values().items():
        try:
            Disturbances.from_dict({name: value})
            found[name] = value
        except DisturbanceError as error:
            section.error(str(error), name)
    return Disturbances.from_dict(found)
