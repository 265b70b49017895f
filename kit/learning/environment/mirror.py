"""Mirrors observations and actions, so that what is learned on one side is known on the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kit.learning.environment.batch_map import UnsupportedWorld
from kit.learning.environment.tasks import LearningTask


class TaskMirror:
    """Mirror images of a task's observations and actions. Raises UnsupportedWorld where its two sides are not alike."""

    def __init__(self, task: LearningTask) -> None:
        try:
            self._order, self._signs = task.observation.mirror_table(task.robots)
            self._moves = task.actions.mirror_table()
        except ValueError as error:
            raise UnsupportedWorld(f"task {task.name} has no mirror image: {error}") from None
        self._task = task

    def observations(self, seen: NDArray[np.float32]) -> NDArray[np.float32]:
        """(n, size), of (n, size)."""
        mirrored: NDArray[np.float32] = seen[..., self._order] * self._signs
        return mirrored

    def actions(self, actions: NDArray[np.integer]) -> NDArray[np.integer]:
        """Of the same shape. The left one of two robots is the right one in a mirror."""
        task = self._task
        choices = self._moves[task.actions.decode(actions, task.robots)][:, ::-1]
        if task.robots > 1 and task.actions.one_number:
            choices = choices[:, :1] * len(self._moves) + choices[:, 1:]
        return choices.reshape(actions.shape)
