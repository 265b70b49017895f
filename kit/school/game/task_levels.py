"""Levels of the game from task files: a task's world, its first case's start and target, its goal and its time.

Such a level has no reference drive and so no medals: there are the time, each driver's best one, and its ghost.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from kit.geometry import Pose
from kit.learning.authoring.task_check import check_task
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.tasks.catalogue import find_task_file, task_names, tasks_folder
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.task_case import TaskCase
from kit.learning.tasks.task_reader import read_task
from kit.plain_text import quoted
from kit.run.scenario import BEACON, Scenario
from kit.school.game.levels import GameLevel, apply_conditions
from kit.sim.simulation import load_world
from kit.world.catalogue import WORLD_FILE, MapCard, MapCase
from kit.world.problems import Problem, WorldError
from kit.world.records import SourceLocation

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
        return self.title if self.title in task_names() else str(_short(self._file))

    @property
    def map_card(self) -> MapCard:
        return self._first_case[0]

    @property
    def _task(self) -> LearningTask:
        assert self.task is not None  # it is made from one
        return self.task

    @property
    def _file(self) -> Path:
        assert self._task.file is not None  # every task is a file
        return self._task.file

    @property
    def _first_case(self) -> tuple[MapCard, TaskCase]:
        return self._task.map_cases()[0]

    def find_scenario(self) -> Scenario:
        """The task's world with its robots at the first case's start. Their motors give what the task's actions ask for at
        most. Raises WorldError."""
        task, (card, case) = self._task, self._first_case
        robots = task.robots_on(card)
        poses = {name: places.nominal for name, places in zip(robots, case.starts, strict=True)}
        world = load_world(card.world_file, root=card.root)
        models = [
            replace(
                model, pose=poses.get(model.name, Pose(*case.target) if model.name == BEACON else model.pose)
            )
            for model in world.models
        ]
        models.sort(key=lambda model: robots.index(model.name) if model.name in robots else len(robots))
        map_case = MapCase(
            case.name,
            case.starts[0].nominal,
            case.target,
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
            self.title,
            replace(world, models=tuple(models)),
            robots[0],
            map_case,
            targets=task.route(case),
            level=self.title if self.title in task_names() else str(self._file.absolute()),
        )
        return apply_conditions(scenario, self.conditions, task.actions.largest)


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
        for each in _refused(task, case)
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
        story=f"Case {quoted(case.name)} of {_short(file)}{f', without {left_out}' if left_out else ''}.",
        skill=f"no more than {limit:g} s; then it is over",
        time_limit=limit,
        goal=task.goal,
        targets=tuple((each.x, each.y) for each in case.targets.poses) if task.goal.is_route else (),
        leader=case.targets.model or "" if task.goal.needs_leader else "",
        task=task,
    )


def _short(file: Path) -> Path:
    """The path from here, where the file is below this folder."""
    here = Path.cwd()
    return file.absolute().relative_to(here) if file.absolute().is_relative_to(here) else file


def _refused(task: LearningTask, case: TaskCase) -> Iterator[str]:
    """Names the features that the task asks for and a level cannot have."""
    if task.robots > MAX_ROBOTS:
        yield f"{task.robots} robots, only {MAX_ROBOTS} that are driven as one"
    if task.goal.race_refusal:
        yield f'the goal "{task.goal.description}": {task.goal.race_refusal}'
    if task.goal.heading_tolerance is not None:
        yield '"heading_tolerance": any heading counts as arrived'
    if task.goal.has_standing_targets:
        if task.measured_to == "axle":
            yield '"measured_to: axle": it measures from the hull to the target'
        if case.targets.model is not None:
            yield f"a target that moves with {case.targets.model}"
        if case.targets.is_area:
            yield f'a target that is drawn ("{case.targets.description}") in its first case, {case.name}: only a place'
    if case.starts[0].is_area:
        yield f'a start that is drawn ("{case.starts[0].description}") in its first case, {case.name}: only a place'


def _left_out(task: LearningTask, case: TaskCase) -> Iterator[str]:
    """Names what the task draws at random and a race leaves out, since it is the same for every driver."""
    if case.is_heading_random or any((*case.start_shift, *case.target_shift)) or task.start.noise:
        yield "its random shifts"
    if task.disturbances or task.lidar_noise:
        yield "its disturbances"
