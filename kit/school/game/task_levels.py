"""Levels of the game from task files: a task's world, its first case's start and target, its goal and its time.

Such a level has no reference drive and so no medals: there are the time, each driver's best one, and its ghost.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from kit.geometry import Pose
from kit.learning.authoring.task_check import check_task
from kit.learning.environment.episode_start import EpisodeStart, first_start
from kit.learning.maps.batch_map import UnsupportedWorld, load_batch_map
from kit.learning.maps.obstacles import Obstacle, phases_of_bodies
from kit.learning.policies.policy_node import node_refusals
from kit.learning.tasks.catalogue import find_task_file, task_names, tasks_folder
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.task_case import TaskCase
from kit.learning.tasks.task_reader import read_task
from kit.plain_text import quoted
from kit.run.scenario import BEACON, Scenario
from kit.school.game.levels import GameLevel, apply_conditions
from kit.school.game.starts import LaterCurve
from kit.sim.card_world import load_card_world
from kit.sim.plugins.tween import MODES, TweenParams
from kit.world.catalogue import WORLD_FILE, MapCard, MapCase
from kit.world.problems import Problem, WorldError
from kit.world.records import Model, PluginSpec, SourceLocation

MAX_ROBOTS = 2
"""That one driver can drive as one."""


@dataclass(frozen=True, slots=True)
class TaskLevel(GameLevel):
    """A level that a task poses: its first case."""

    task: LearningTask | None = field(default=None, compare=False, repr=False)
    """Never None; two versions of a task are two levels, by their ids."""

    @property
    def has_medals(self) -> bool:
        return False

    @property
    def command_name(self) -> str:
        return self.title if self.title in task_names() else str(_short_path(self.file))

    @property
    def map_card(self) -> MapCard:
        return self._first_case[0]

    @property
    def learning_task(self) -> LearningTask:
        """The task that poses it."""
        assert self.task is not None  # it is made from one
        return self.task

    @property
    def file(self) -> Path:
        """The task's file."""
        assert self.learning_task.file is not None  # every task is a file
        return self.learning_task.file

    @property
    def _first_case(self) -> tuple[MapCard, TaskCase]:
        return self.learning_task.map_cases()[0]

    def find_scenario(self) -> Scenario:
        """The task's world with its robots at the first case's start, or at the first that is drawn where none is given.
        Their motors give what the task's actions ask for at most. Raises WorldError."""
        return episode_scenario(self, first_start(self.learning_task))


def episode_scenario(level: TaskLevel, start: EpisodeStart) -> Scenario:
    """The world of a task's first case as an episode begins there. Raises WorldError."""
    task, (card, case) = level.learning_task, level.learning_task.map_cases()[0]
    robots = task.robots_on(card)
    poses = dict(zip(robots, start.robots, strict=True))
    x, y, heading = start.target
    world = load_card_world(card)
    models = [
        replace(model, pose=poses.get(model.name, Pose(x, y) if model.name == BEACON else model.pose))
        for model in world.models
    ]
    if start.phase is not None:
        models = _moved_on(models, load_batch_map(card, robots).obstacles, start.phase)
    models.sort(key=lambda model: robots.index(model.name) if model.name in robots else len(robots))
    map_case = MapCase(
        case.name,
        start.robots[0],
        (x, y),
        task.target_radius,
        (0.0, 0.0),
        (0.0, 0.0),
        is_heading_random=False,
        group=case.group,
        partner_start=poses[robots[1]] if len(robots) > 1 else None,
    )
    is_kit_map = card.name in task.maps and card.world_file == card.folder / WORLD_FILE
    scenario = Scenario(
        card.name if is_kit_map else str(card.world_file.absolute()),
        level.title,
        replace(world, models=tuple(models)),
        robots[0],
        map_case,
        targets=task.route(case),
        target_heading=None if task.goal.heading_tolerance is None else heading,
        leader=case.targets.model,
        level=level.title if level.title in task_names() else str(level.file.absolute()),
    )
    return apply_conditions(scenario, level.conditions, task.actions.largest)


def _moved_on(models: Sequence[Model], obstacles: Sequence[Obstacle], phase: float) -> list[Model]:
    """The models as they are on their ways when an episode begins; each is elsewhere, as in training."""
    phases = dict(
        zip(
            (each.name for each in obstacles),
            phases_of_bodies(np.array([phase]), len(obstacles))[0].tolist(),
            strict=True,
        )
    )
    return [
        replace(model, plugins=tuple(_advance_cart(each, phases[model.name]) for each in model.plugins))
        if model.name in phases
        else model
        for model in models
    ]


def _advance_cart(plugin: PluginSpec, phase: float) -> PluginSpec:
    """A cart's plugin after this share of its whole way; any other as it is."""
    params = plugin.params
    if not isinstance(params, TweenParams) or params.progress is None:
        return plugin
    turns = 2.0 * phase if params.progress is MODES["yoyo"] else phase
    return replace(plugin, params=replace(params, progress=LaterCurve(params.progress, turns)))


def find_task_level(name: str) -> TaskLevel | None:
    """The level of a task's file or its folder, of a task of that name in the workspace, or of one of the kit's; None if
    there is none. WorldError if the file is wrong, or a level cannot be what it asks for."""
    file = _find_file(name)
    return None if file is None else task_level(file)


def _find_file(name: str) -> Path | None:
    try:
        return find_task_file(name) or tasks_folder() / f"{name}.yaml"
    except UnknownTask:
        return None


def task_level(file: Path) -> TaskLevel:
    """The level that a task's file poses. WorldError with all that is wrong with it, or that a level cannot carry."""
    read = read_task(file)
    with suppress(UnsupportedWorld):  # nobody can learn it, but the simulator can drive it
        check_task(replace(read, task=replace(read.task, reward_file=None)))
    task = read.task
    cases = task.map_cases()
    _, case = cases[0]
    refused = [
        Problem(SourceLocation(file), f"a level of the game cannot have {each}")
        for each in race_refusals(task)
    ]
    if refused:
        raise WorldError(refused)
    limit = task.max_steps * task.step_time
    left_out = ", ".join(_left_out(task, case))
    return TaskLevel(
        id=f"{task.name}-{task.version}",
        title=task.name,
        map_name=cases[0][0].name,
        case=case.name,
        hint=f"{task.goal.description[0].upper()}{task.goal.description[1:]}.",
        opened_by=(),
        row=0,
        story=f"Case {quoted(case.name)} of {_short_path(file)}{f', without {left_out}' if left_out else ''}.",
        skill=f"no more than {limit:g} s; then it is over",
        time_limit=limit,
        goal=task.goal,
        targets=tuple((each.x, each.y) for each in case.targets.poses) if task.goal.is_route else (),
        leader=case.targets.model or "",
        measured_to=task.measured_to,
        task=task,
    )


def _short_path(file: Path) -> Path:
    """The path from here, where the file is below this folder."""
    here = Path.cwd()
    return file.absolute().relative_to(here) if file.absolute().is_relative_to(here) else file


def race_refusals(task: LearningTask) -> Iterator[str]:
    """Names the features that the task asks for and a level cannot have."""
    if task.robots > MAX_ROBOTS:
        yield f"{task.robots} robots, only {MAX_ROBOTS} that are driven as one"


def race_command(task: LearningTask, agent: str) -> str:
    """The command that races an agent, a run or a policy's file, in a task; empty where the task or its file cannot be raced.

    UnsupportedWorld and WorldError for a world that nobody can learn in.
    """
    if next(race_refusals(task), None) is not None or node_refusals(task):
        return ""
    name = task.name
    if name not in task_names():
        if task.file is None or not task.file.is_file():
            return ""
        name = shlex.quote(str(_short_path(task.file)))
    return f"kit game race {name} --agent {agent}"


def _left_out(task: LearningTask, case: TaskCase) -> Iterator[str]:
    """Names what the task draws at random and a race leaves out, since it is the same for every driver."""
    if case.is_heading_random or any((*case.start_shift, *case.target_shift)) or task.start.noise:
        yield "its random shifts"
    if task.disturbances or task.lidar_noise:
        yield "its disturbances"
