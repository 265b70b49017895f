"""The batch engine as a vector environment of Gymnasium."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.env import resolve_task
from kit.learning.environment.episode_stats import EpisodeStatsRecorder
from kit.learning.environment.rewards import RewardFunction
from kit.learning.environment.tasks import HALLWAY, TURN, WHEELCHAIRS, LearningTask

ObservationArray = NDArray[np.float32]


class BatchVectorEnv(VectorEnv[ObservationArray, NDArray[np.int64], NDArray[Any]]):
    """``num_envs`` worlds of a task. A world resets itself in the step in which its episode ends (autoreset mode
    ``SAME_STEP``, as in stable-baselines3): ``info["final_obs"]`` and ``info["final_info"]`` are of that episode.
    """

    default_task: ClassVar[LearningTask] = TURN

    def __init__(
        self,
        num_envs: int,
        task: LearningTask | Path | str | None = None,
        *,
        case: str | None = None,
        reward: RewardFunction | None = None,
        seed: int | None = None,
    ) -> None:
        """``task``: a variant of the class's own, the name of a task, or a task's file. ``case``: only this case or group of
        cases. ``reward``: instead of the task's own. ``seed``: by chance if None."""
        self.metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.SAME_STEP}
        self.num_envs = num_envs
        seed = int(np.random.default_rng().integers(2**31)) if seed is None else seed
        found = resolve_task(task, self.default_task)
        self.batch = BatchEnv(found if case is None else found.on(case), num_envs, seed, reward=reward)
        self.single_observation_space = self.batch.observation_space
        self.single_action_space = self.batch.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._recorder = EpisodeStatsRecorder(self.batch)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ObservationArray, dict[str, Any]]:
        """Begins new episodes. One seed is enough: each world has its own randomness by its number."""
        if isinstance(seed, list):
            raise ValueError("give one seed: each world has its own randomness by its number")
        self._recorder = EpisodeStatsRecorder(self.batch)
        return self.batch.reset(seed), {}

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[ObservationArray, NDArray[Any], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        step = self.batch.step(np.asarray(actions))
        info: dict[str, Any] = {}
        for episode in self._recorder.add(step):
            final = {
                "episode": {"r": episode.reward, "l": episode.steps},
                "case": episode.case,
                "outcome": episode.outcome.value,
            }
            seen = step.final_observations[episode.world]
            info = self._add_info(info, {"final_obs": seen, "final_info": final}, episode.world)
        return step.observations, step.rewards, step.terminated, step.truncated, info


class TurnVectorEnv(BatchVectorEnv):
    """Many worlds of ``RobotKit/Turn-v0``."""

    default_task = TURN


class HallwayVectorEnv(BatchVectorEnv):
    """Many worlds of ``RobotKit/Hallway-v0``."""

    default_task = HALLWAY


class WheelchairsVectorEnv(BatchVectorEnv):
    """Many worlds of ``RobotKit/Wheelchairs-v0``."""

    default_task = WHEELCHAIRS
