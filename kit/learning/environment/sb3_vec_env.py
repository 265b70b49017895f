"""The batch engine as a vector environment of stable-baselines3 (needs the extra ``learn``)."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kit.arrays import Float32Array, IntArray, Uint8Array
from kit.installation import install_command
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.env import build_batch_scene, case_number, check_options, picture_of
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStats, EpisodeStatsRecorder
from kit.learning.environment.mirror import TaskMirror
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.reward import RewardFunction
from kit.plain_text import counted, quoted

try:
    from stable_baselines3.common.monitor import Monitor
    from stable_baselines3.common.vec_env import VecEnv, VecEnvWrapper
    from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvObs, VecEnvStepReturn
except ImportError:
    raise ImportError(
        f"stable-baselines3 is not installed. To have it, type: {install_command('learn')}"
    ) from None


class BatchVecEnv(VecEnv):
    """A BatchEnv (``.batch``) for the algorithms of stable-baselines3, which needs no Monitor around it.

    A world resets itself in the step in which its episode ends, as all vector environments of that library do. The
    ``info`` of that step then holds ``terminal_observation`` (what was seen before the reset), ``TimeLimit.truncated``,
    ``episode`` (``r`` the sum of rewards, ``l`` steps, ``t`` seconds since the start, as Monitor gives them), ``case``,
    ``outcome``, ``terms`` (the reward by named term) and, for two robots, ``adjacency``. ``reset_infos`` holds each world's
    ``case`` after ``reset``, for which ``set_options({"case": name})`` can choose one.
    """

    def __init__(self, batch: BatchEnv, render_mode: str | None = None) -> None:
        """``render_mode``: ``rgb_array``, if ``render`` and ``get_images`` are to return pictures. ValueError for another."""
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"many worlds have only the render mode rgb_array, not {quoted(render_mode)}")
        self.batch = batch
        self._render_mode = render_mode
        self._recorder = EpisodeStatsRecorder(batch)
        self._actions: NDArray[np.integer] = np.zeros(0, dtype=np.int64)
        self._started = time.perf_counter()
        super().__init__(batch.n, batch.observation_space, batch.action_space)
        self.metadata["render_fps"] = round(1.0 / batch.task.step_time)

    def __repr__(self) -> str:
        """``BatchVecEnv(turn, 64 worlds)``"""
        return f"{type(self).__name__}({self.batch.task.name}, {counted(self.num_envs, 'world')})"

    def reset(self) -> VecEnvObs:
        """Begins new episodes in all worlds; after ``seed``, with that seed, and after ``set_options``, with these cases.

        Raises ValueError for another option, and UnknownTask for a case that there is not."""
        seed, cases = self._seeds[0], self._wanted_cases()
        self._reset_seeds()
        self._reset_options()
        self._recorder = EpisodeStatsRecorder(self.batch)
        seen = self.batch.reset(None if seed is None else int(seed), cases=cases)
        self.reset_infos = [{"case": self.batch.cases[case].name} for case in self.batch.state.case.tolist()]
        return seen

    def _wanted_cases(self) -> IntArray | None:
        """The cases' numbers that ``set_options`` has chosen; -1 where it has chosen none."""
        for options in self._options:
            check_options(options, "case")
        numbers = [case_number(self.batch.task, options.get("case")) for options in self._options]
        if all(number is None for number in numbers):
            return None
        return np.array([-1 if number is None else number for number in numbers], dtype=np.int64)

    def step_async(self, actions: NDArray[np.integer]) -> None:
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        step = self.batch.step(self._actions)
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for episode, last in zip(self._recorder.add(step), step.last_observations, strict=True):
            info = infos[episode.world]
            info |= self._episode_info(episode)
            info["terminal_observation"] = last
            info["TimeLimit.truncated"] = bool(step.truncated[episode.world])
        return step.observations, step.rewards, step.ended, infos

    def _episode_info(self, episode: EpisodeStats) -> dict[str, Any]:
        seconds = time.perf_counter() - self._started
        info: dict[str, Any] = {
            "episode": {"r": episode.reward, "l": episode.steps, "t": seconds},
            "case": episode.case,
            "outcome": episode.outcome.value,
            "is_success": episode.outcome is EpisodeOutcome.REACHED,
            "terms": episode.terms,
        }
        return info | ({"adjacency": episode.adjacency} if self.batch.task.robots > 1 else {})

    def close(self) -> None:
        """Does nothing: a batch holds no files and no processes."""

    # All worlds share their attributes: there is one object behind them.

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        value = self._render_mode if attr_name == "render_mode" else getattr(self.batch, attr_name)
        return [value] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        raise AttributeError(f"{attr_name} cannot be set for only some worlds of a batch")

    def env_method(
        self, method_name: str, *method_args: Any, indices: VecEnvIndices = None, **method_kwargs: Any
    ) -> list[Any]:
        raise AttributeError(f"{method_name} cannot be called for only some worlds of a batch")

    def env_is_wrapped(self, wrapper_class: type[Any], indices: VecEnvIndices = None) -> list[bool]:
        """Whether each world has what a Monitor adds: it does; and is in no other wrapper."""
        return [wrapper_class is Monitor] * len(list(self._get_indices(indices)))

    def get_images(self) -> Sequence[Uint8Array | None]:
        """(height, width, 3) a picture of every world, in the mode ``rgb_array``."""
        if self._render_mode is None:
            return [None] * self.num_envs
        scenes = (build_batch_scene(self.batch, world) for world in range(self.num_envs))
        return [picture_of(scene, self._render_mode) for scene in scenes]


class HalfMirroredVecEnv(VecEnvWrapper):
    """Mirrors every second world of each case, in observations and actions. The worlds themselves are unchanged."""

    def __init__(self, venv: BatchVecEnv) -> None:
        super().__init__(venv)
        self._mirror = TaskMirror(venv.batch.task)
        self._which = np.flatnonzero(np.arange(venv.num_envs) // len(venv.batch.cases) % 2)

    def _mirror_observations(self, observations: Any) -> Float32Array:
        seen: Float32Array = observations.copy()
        seen[self._which] = self._mirror.observations(seen[self._which])
        return seen

    def reset(self) -> VecEnvObs:
        return self._mirror_observations(self.venv.reset())

    def step_async(self, actions: NDArray[np.integer]) -> None:
        driven = actions.copy()
        driven[self._which] = self._mirror.actions(actions[self._which])
        self.venv.step_async(driven)

    def step_wait(self) -> VecEnvStepReturn:
        observations, rewards, dones, infos = self.venv.step_wait()
        for number in self._which[dones[self._which]]:
            info = infos[number]
            info["terminal_observation"] = self._mirror.observations(info["terminal_observation"])
        return self._mirror_observations(observations), rewards, dones, infos


def make_vec_env(
    task: LearningTask | Path | str,
    n: int,
    seed: int = 0,
    reward: RewardFunction | None = None,
    *,
    fixed_cases: bool = False,
    render_mode: str | None = None,
) -> BatchVecEnv:
    """``n`` worlds of one task side by side, for the algorithms of stable-baselines3 (needs the extra ``learn``).

    ``task``: a task, the name of one of the kit's, or the file of one of your own. ``reward``: instead of the task's, a
    function of a transition, for all worlds at once. ``fixed_cases``: whether each world runs one case for good.
    ``render_mode="rgb_array"``: with pictures, for a VecVideoRecorder.

    Raises UnknownTask if there is no such task, WorldError if its file is wrong, ValueError for fewer than one world and
    another render mode, and TypeError for a reward that is no function.

    >>> worlds = kit.make_vec_env("turn", 64, seed=1)
    >>> worlds.reset().shape
    (64, 9)
    """
    found = task if isinstance(task, LearningTask) else find_task(str(task))
    return BatchVecEnv(BatchEnv(found, n, seed, reward=reward, fixed_cases=fixed_cases), render_mode)
