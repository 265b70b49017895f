"""Worlds seen in a mirror: what is learned on one side is known on the other (needs the extra ``learn``)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnvWrapper
from stable_baselines3.common.vec_env.base_vec_env import VecEnvObs, VecEnvStepReturn

from kit.learning.tasks import Task
from kit.learning.vecenv import BatchVecEnv


class Mirror:
    """What left and right become in a mirror. Raises ValueError where the two sides of a task are not alike."""

    def __init__(self, task: Task) -> None:
        self._order, self._signs = task.observation.mirrored(task.robots)
        self._moves = task.actions.mirrored()
        self._task = task

    def observations(self, seen: NDArray[np.float32]) -> NDArray[np.float32]:
        """(n, size), of (n, size)."""
        mirrored: NDArray[np.float32] = seen[..., self._order] * self._signs
        return mirrored

    def actions(self, actions: NDArray[np.integer]) -> NDArray[np.integer]:
        """Of the same shape. The left one of two robots is the right one in a mirror."""
        task = self._task
        choices = self._moves[task.actions.chosen(actions, task.robots)][:, ::-1]
        if task.robots > 1 and task.actions.one_number:
            choices = choices[:, :1] * len(self._moves) + choices[:, 1:]
        return choices.reshape(actions.shape)


class HalfMirrored(VecEnvWrapper):
    """Of every case, each second world is seen in a mirror, and driven so. The worlds themselves are as they were."""

    def __init__(self, venv: BatchVecEnv) -> None:
        super().__init__(venv)
        self._mirror = Mirror(venv.batch.task)
        self._which = np.flatnonzero(np.arange(venv.num_envs) // len(venv.batch.cases) % 2)

    def _mirrored(self, observations: Any) -> NDArray[np.float32]:
        seen: NDArray[np.float32] = observations.copy()
        seen[self._which] = self._mirror.observations(seen[self._which])
        return seen

    def reset(self) -> VecEnvObs:
        return self._mirrored(self.venv.reset())

    def step_async(self, actions: NDArray[np.integer]) -> None:
        driven = actions.copy()
        driven[self._which] = self._mirror.actions(actions[self._which])
        self.venv.step_async(driven)

    def step_wait(self) -> VecEnvStepReturn:
        observations, rewards, dones, infos = self.venv.step_wait()
        for number in self._which[dones[self._which]]:
            info = infos[number]
            info["terminal_observation"] = self._mirror.observations(info["terminal_observation"])
        return self._mirrored(observations), rewards, dones, infos
