"""Mirrors observations and actions, so that what is learned on one side is known on the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kit.arrays import Float32Array
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.tasks.learning_task import LearningTask


class TaskMirror:
    """Mirror images of a task's observations and actions. Raises UnsupportedWorld where its two sides are not alike."""

    def __init__(self, task: LearningTask) -> None:
        try:
            self._order, self._signs = task.observation.mirror_table(task.robots)
            still = np.zeros_like(task.actions.space(task.robots).sample())
            task.actions.mirror(still[None], task.robots)
        except ValueError as error:
            raise UnsupportedWorld(f"task {task.name} has no mirror image: {error}") from None
        self._task = task

    def observations(self, seen: Float32Array) -> Float32Array:
        """(n, size), of (n, size)."""
        mirrored: Float32Array = seen[..., self._order] * self._signs
        return mirrored

    def actions(self, actions: NDArray[np.generic]) -> NDArray[np.generic]:
        """Returns mirrored actions of the same shape. The left one of two robots is the right one in the mirror."""
        return self._task.actions.mirror(actions, self._task.robots)
