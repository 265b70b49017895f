"""The tasks to learn by name: the kit's, which are the files of this folder, and those of users' files.

Where the seed's text and its code differ, the text counts.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

from kit.extensions import folders
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.own_files import workspace_task_file
from kit.learning.tasks.task_reader import TASK_FILE, read_task
from kit.plain_files import is_file_there
from kit.plain_text import quoted, unknown_name
from kit.workspace import expand_home


def tasks_folder() -> Path:
    """Returns the folder of the kit's own tasks: their files lie beside this module."""
    return Path(__file__).resolve().parent


def task_names() -> tuple[str, ...]:
    """The names of the kit's tasks, without reading them."""
    return tuple(sorted(file.stem for file in tasks_folder().glob("*.yaml")))


def find_task(name: str) -> LearningTask:
    """The task of that name; else that of a file, of a folder with a ``task.yaml``, or of that name in the workspace.

    UnknownTask if there is none; WorldError if its file is wrong.

    >>> kit.find_task("turn").max_steps
    200
    """
    file = find_task_file(name)
    return _kit_task(name) if file is None else read_task(file).task


def find_task_file(name: str) -> Path | None:
    """The file that a name means: a file, a folder with a ``task.yaml``, or a task of that name in the workspace.

    None if it is that of a task of the kit's. UnknownTask if it is none of these.
    """
    names = task_names()
    if name in names:
        return None
    path = expand_home(name)
    if is_file_there(path / TASK_FILE):
        return path / TASK_FILE
    if is_file_there(path):
        return path
    if path.suffix in (".yaml", ".yml") or len(path.parts) > 1:
        raise UnknownTask(f"There is no file {quoted(name, 200)}.")
    if own := workspace_task_file(name):
        return own
    for _, folder in folders("tasks"):
        if is_file_there(folder / f"{name}.yaml"):
            return folder / f"{name}.yaml"
    raise UnknownTask(unknown_name("task", name, names, "kit train --list"))


@cache
def _kit_task(name: str) -> LearningTask:
    return read_task(tasks_folder() / f"{name}.yaml").task


def all_tasks() -> tuple[LearningTask, ...]:
    """Every task of the kit's: those to begin with, then those as in the dissertation."""
    return (*first_tasks(), *dissertation_tasks())


def first_tasks() -> tuple[LearningTask, ...]:
    """The three tasks of the dissertation as the kit poses them, then our own by name."""
    own = [name for name in task_names() if name not in {task.name for task in TASKS}]
    return (TURN, HALLWAY, WHEELCHAIRS, *map(find_task, own))


def dissertation_tasks() -> tuple[LearningTask, ...]:
    """The variants by which the dissertation's numbers are repeated: as its text or its code has them."""
    return tuple(each for each in TASKS if each not in (TURN, HALLWAY, WHEELCHAIRS))


TURN: Final = find_task("turn")
TURN_SEED: Final = find_task("turn-seed")
HALLWAY: Final = find_task("hallway")
HALLWAY_SEED: Final = find_task("hallway-seed")
WHEELCHAIRS: Final = find_task("wheelchairs")
WHEELCHAIRS_SEED: Final = find_task("wheelchairs-seed")
WHEELCHAIRS_SEED_49: Final = find_task("wheelchairs-seed-49")
WHEELCHAIRS_SEED_49_WIDE: Final = find_task("wheelchairs-seed-49-wide")

TASKS: Final = (
    TURN,
    TURN_SEED,
    HALLWAY,
    HALLWAY_SEED,
    find_task("hallway-seed-as-run"),
    WHEELCHAIRS,
    WHEELCHAIRS_SEED,
    find_task("wheelchairs-seed-as-run"),
    WHEELCHAIRS_SEED_49,
    find_task("wheelchairs-seed-49-as-run"),
    WHEELCHAIRS_SEED_49_WIDE,
    find_task("wheelchairs-seed-49-wide-as-run"),
)
"""Those of the dissertation, and what the kit made of them."""
