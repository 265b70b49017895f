"""Many worlds of one task as arrays, stepped by compiled loops."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kit.learning.rewards import Array, RewardFunction, Transition
from kit.learning.tasks import Task
from kit.world.catalogue import Case

Singles = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """What a step of all worlds gave. A world whose episode has ended is in its next one already."""

    observations: Singles
    """(n, size): of the running episodes."""
    rewards: Singles
    """(n,)"""
    terminated: NDArray[np.bool_]
    """(n,)"""
    truncated: NDArray[np.bool_]
    """(n,)"""
    final_observations: Singles
    """(n, size): what was seen before the reset; equal to ``observations`` where nothing has ended."""
    transition: Transition
    """Of n worlds, before the reset."""
    terms: dict[str, Array]
    """(n,) each: the reward by named term; empty for a student's reward."""


class BatchEnv:
    """``n`` worlds of a task. World i depends on (task, seed, first + i) and its own actions alone: it is the same
    to the bit alone or among many.

    Cases are dealt in turn: episode k of world i runs case number ``first + i + k``, counted round and round.
    ``reward``: instead of the task's own.
    """

    def __init__(
        self, task: Task, n: int, seed: int = 0, *, reward: RewardFunction | None = None, first: int = 0
    ) -> None:
        self.task = task
        self.n = n
        self.cases: tuple[Case, ...] = tuple(case for _, case in task.courses())
        self.observation_space = task.observation.space(task.robots)
        self.action_space = task.actions.space(task.robots)
        raise NotImplementedError

    def reset(self, seed: int | None = None, *, cases: NDArray[np.int64] | None = None) -> Singles:
        """(n, size) the first observations of new episodes, in every world.

        ``seed``: starts everything anew, else the worlds go on to their next episodes. ``cases``: (n,) numbers
        of the cases that these episodes run, instead of those dealt in turn.
        """
        raise NotImplementedError

    def step(self, actions: NDArray[np.integer]) -> Step:
        """Every world does one step; ``actions``: (n,), or (n, robots) where the space is MultiDiscrete."""
        raise NotImplementedError
