"""The tasks to learn, the kit's and those of users' files, by name; and how a file describes one with what was changed in it.

The kit's are the files of the folder ``tasks``. Where the seed's text and its code differ, the text counts.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import Any, Final, Literal

from kit.extensions import folders
from kit.field_types import check_field_types
from kit.learning.environment.actions import DiscreteActions
from kit.learning.environment.disturbances import Disturbances
from kit.learning.environment.rewards import REWARD_SCALE, REWARDS
from kit.learning.tasks.learning_task import LearningTask as LearningTask
from kit.learning.tasks.learning_task import StartVariation as StartVariation
from kit.learning.tasks.learning_task import UnknownTask as UnknownTask
from kit.learning.tasks.own_files import workspace_task_file
from kit.learning.tasks.task_reader import TASK_FILE, read_task, task_name
from kit.plain_files import is_file_there, read_plain_file
from kit.plain_text import quoted, suggestion
from kit.workspace import expand_home
from kit.world.documents import MAX_YAML_BYTES


def tasks_folder() -> Path:
    """Returns the folder of the kit's own tasks: their files lie beside the module that reads them."""
    return Path(__file__).resolve().parents[1] / "tasks"


def task_names() -> tuple[str, ...]:
    """The names of the kit's tasks, without reading them."""
    return tuple(sorted(file.stem for file in tasks_folder().glob("*.yaml")))


def find_task(name: str) -> LearningTask:
    """The task of that name; else that of a file, of a folder with a ``task.yaml``, or of that name in the workspace.

    UnknownTask if there is none; WorldError if its file is wrong.
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
        raise UnknownTask(f"there is no file {quoted(name, 200)}")
    if own := workspace_task_file(name):
        return own
    for _, folder in folders("tasks"):
        if is_file_there(folder / f"{name}.yaml"):
            return folder / f"{name}.yaml"
    raise UnknownTask(f"there is no task {quoted(name)}: {suggestion(name, names)}")


@cache
def _kit_task(name: str) -> LearningTask:
    return read_task(tasks_folder() / f"{name}.yaml").task


def all_tasks() -> tuple[LearningTask, ...]:
    """Every task of the kit's: those of the dissertation first, then our own by name."""
    own = [name for name in task_names() if name not in {task.name for task in TASKS}]
    return (*TASKS, *map(find_task, own))


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
    WHEELCHAIRS,
    WHEELCHAIRS_SEED,
    WHEELCHAIRS_SEED_49,
    WHEELCHAIRS_SEED_49_WIDE,
)
"""Those of the dissertation, and what the kit made of them."""


@dataclass(frozen=True, slots=True)
class TaskSpec:
    """A task of ``TASKS``, by name, and what is different from it. None leaves a setting as it is."""

    task: str
    """Or the file of a task of the user's own, or its folder."""
    on: tuple[str, ...] = ()
    """Cases or groups of cases; all where empty."""
    measured_to: Literal["hull", "axle"] | None = None
    tells_target: bool | None = None
    tells_arrived: bool | None = None
    reward: str | None = None
    """Another one of ``REWARDS``. It stays small where the task's own is small."""
    scale: float | None = None
    """Factor of the reward."""
    one_number: bool | None = None
    """Whether a pair's moves are one number."""
    timeout_terminal: bool | None = None
    disturbances: Disturbances | None = None
    """Instead of the task's own."""
    text: str | None = None
    """What the task's file held when it was chosen: later changes of the file change nothing."""

    def frozen(self) -> TaskSpec:
        """The same with the text of the task's file, so that it stays what it is; for a task of the kit's as it is.

        UnknownTask if there is no such task; WorldError if its file is wrong.
        """
        file = None if self.text is not None else find_task_file(self.task)
        if file is None:
            return self
        return replace(self, task=str(file.absolute()), text=read_task(file).text)

    @property
    def has_changed(self) -> bool:
        """Whether the task's file holds something else by now."""
        if self.text is None:
            return False
        try:
            return read_plain_file(self.task, MAX_YAML_BYTES).decode("utf-8-sig") != self.text
        except (OSError, ValueError):  # gone, or no text any more: the task is kept here
            return False

    @property
    def name(self) -> str:
        """The name of the task, also where it is a file."""
        if self.text is not None or self.task not in task_names():
            return task_name(Path(self.task))
        return self.task

    def resolve(self) -> LearningTask:
        """The task. UnknownTask if something has no such name; WorldError if a task's file is wrong."""
        task = find_task(self.task) if self.text is None else read_task(Path(self.task), self.text).task
        if self.on:
            task = task.on(*self.on)
        observation, actions, reward = task.observation, task.actions, task.reward
        if self.reward is not None:
            if self.reward not in REWARDS:
                raise UnknownTask(
                    f"there is no reward {quoted(self.reward)}: {suggestion(self.reward, REWARDS)}"
                )
            other = REWARDS[self.reward]
            scale = 1.0 if other.is_small else REWARD_SCALE if reward.is_small else reward.scale
            reward = replace(other, scale=scale)
        if self.scale is not None:
            reward = replace(reward, scale=self.scale)
        if self.tells_target is not None:
            observation = replace(observation, target=self.tells_target)
        if self.tells_arrived is not None:
            observation = replace(observation, arrived=self.tells_arrived)
        if self.one_number is not None:
            if not isinstance(actions, DiscreteActions):
                raise UnknownTask(f"the actions of task {task.name} are not discrete")
            actions = replace(actions, one_number=self.one_number)
        task = replace(task, observation=observation, actions=actions, reward=reward)
        if self.measured_to is not None:
            task = replace(task, measured_to=self.measured_to)
        if self.timeout_terminal is not None:
            task = replace(task, timeout_terminal=self.timeout_terminal)
        if self.disturbances is not None:
            task = replace(task, disturbances=self.disturbances)
        return task

    def as_dict(self) -> dict[str, Any]:
        """JSON-able: what differs from nothing."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        told = {name: value for name, value in values.items() if value not in (None, ())}
        return told if self.disturbances is None else {**told, "disturbances": self.disturbances.as_dict()}

    @classmethod
    def from_dict(cls, data: Any) -> TaskSpec:
        """Reads what ``as_dict`` returned. Raises ValueError for anything else."""
        known = {field.name for field in fields(cls)}
        if not isinstance(data, dict) or "task" not in data or set(data) - known:
            raise ValueError("not a choice of a task")
        settings = {name: value for name, value in data.items() if name != "disturbances"}
        check_field_types(cls, settings)
        if "disturbances" in data:
            settings["disturbances"] = Disturbances.from_dict(data["disturbances"])
        return cls(**{**settings, "on": tuple(data.get("on", ()))})

    @property
    def title(self) -> str:
        """``hallway on doors``; ``turn, disturbed``."""
        title = f"{self.name} on {', '.join(self.on)}" if self.on else self.name
        return f"{title}, disturbed" if self.disturbances else title
