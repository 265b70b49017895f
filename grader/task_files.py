"""Tasks to learn that an assignment names: the kit's by name, or a task file in the assignment's own folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from kit.geometry import Pose
from kit.learning.tasks.catalogue import task_names
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.student_reward import RewardFileError
from kit.learning.tasks.task_case import TaskCase
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.plain_files import is_file_there
from kit.plain_text import quoted, suggestion
from kit.run.scenario import Scenario, scenario_on_map
from kit.world.catalogue import MapCard, MapCase
from kit.world.problems import WorldError
from kit.world.yaml_section import Section


def assignment_task(name: str, folder: Path) -> TaskSpec:
    """The task of that name, or that of a file of this name in ``folder``. UnknownTask if it is neither."""
    if name in task_names():
        return TaskSpec(name)
    file = (folder / name).resolve()
    if not file.is_relative_to(folder.resolve()) or not is_file_there(file):
        raise UnknownTask(
            f"there is no task {quoted(name)}: {suggestion(name, task_names())}, nor a file of that name in this folder"
        )
    return TaskSpec(str(file))


def read_task_choice(section: Section, folder: Path) -> TaskSpec | None:
    """Reads the key ``task`` and checks the task with its worlds; notes a mistake and returns None."""
    name = section.name("task")
    if not name:
        return None
    try:
        choice = assignment_task(name, folder)
    except UnknownTask as error:
        section.error(str(error), "task")
        return None
    problem = None if choice.task in task_names() else problem_of_task(Path(choice.task))
    if problem is not None:
        section.error(problem, "task")
        return None
    return choice


def problem_of_task(file: Path) -> str | None:
    """Says what is wrong with a task's file or its worlds; None if nothing is."""
    try:
        found = read_task(file)
    except (UnknownTask, WorldError, OSError) as error:
        return str(error)
    # Only now: this loads all that worlds in batches take, and a slip in the file is told at once.
    from kit.learning.authoring.task_check import check_task
    from kit.learning.maps.batch_map import UnsupportedWorld

    try:
        check_task(found)
    except (UnknownTask, WorldError, UnsupportedWorld, RewardFileError, OSError) as error:
        return str(error)
    return None


def task_scenario(task: LearningTask, case: str | None = None) -> Scenario:
    """The world of one case of a task, by default its first, as a controller or an environment drives in it: with the
    robot at the case's start and its target. Raises LookupError for an unknown case, and WorldError."""
    cases = task.map_cases()
    for card, found in cases:
        if case is None or found.name == case:
            scenario = scenario_on_map(card, _map_case(task, card, found))
            return replace(scenario, targets=task.route(found))
    names = [found.name for _, found in cases]
    raise LookupError(f"no case {quoted(case or '')} in task {task.name}: {suggestion(case or '', names)}")


def _map_case(task: LearningTask, card: MapCard, case: TaskCase) -> MapCase:
    start = case.starts[0].nominal
    partner = case.starts[1].nominal if card.partner is not None and len(case.starts) > 1 else None
    return MapCase(
        case.name, Pose(*start), case.target, task.target_radius, (0.0, 0.0), (0.0, 0.0), False, "", partner
    )
