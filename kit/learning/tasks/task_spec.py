"""A task with what was changed in it, as a run's or a policy's file describes it."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Literal

from kit.field_types import check_field_types
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.catalogue import find_task, find_task_file, task_names
from kit.learning.tasks.disturbances import Disturbances
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.rewards import REWARD_SCALE, REWARDS
from kit.learning.tasks.task_reader import read_task, task_name
from kit.plain_files import read_plain_file
from kit.plain_text import quoted, suggestion
from kit.world.documents import MAX_YAML_BYTES


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
