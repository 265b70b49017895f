"""Many worlds of one task as a vector environment of Gymnasium, which keeps its whole contract: what it returns is what as many
single environments side by side return, and with one case to the bit."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from kit.arrays import BoolArray, FloatArray, IntArray
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.environment.env import (
    ActionArray,
    ObservationArray,
    TaskEnv,
    build_batch_scene,
    case_number,
    check_options,
    check_render_mode,
    picture_of,
    picture_title,
    resolve_task,
    step_info,
    with_step_limit,
)
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.tasks.catalogue import HALLWAY, TURN, WHEELCHAIRS
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.reward import RewardFunction
from kit.plain_text import quoted, suggestion
from kit.render.world_text import TerminalPicture

_NOT_ALONE = "the worlds of a batch share their attributes, and"
_ALONE = '. With vectorization_mode="sync" every world is an environment of its own'


class BatchVectorEnv(VectorEnv[ObservationArray, ActionArray, NDArray[Any]]):
    """``num_envs`` worlds of a task, which are simulated all at once.

    World i of a ``reset(seed=s)`` has the randomness of a single environment with the seed s + i; worlds take the cases in
    turn, each beginning with another one.
    """

    default_task: ClassVar[LearningTask] = TURN

    def __init__(
        self,
        num_envs: int,
        task: LearningTask | Path | str | None = None,
        *,
        case: str | None = None,
        reward: RewardFunction | None = None,
        render_mode: str | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        max_episode_steps: int | None = None,
    ) -> None:
        """``task``: a variant of the class's own, the name of a task, or a task's file. ``case``: only this case or group of
        cases. ``reward``: instead of the task's own. ``render_mode``: as a single environment has it; ``rgb_array`` and
        ``ansi`` are of every world, ``human`` paints the first one. ``autoreset_mode``: whether a world whose episode has
        ended begins the next one in the next step, in the same, or by ``reset`` with a mask. ``max_episode_steps``: after so
        many an episode is truncated, as by Gymnasium's TimeLimit.

        Raises ValueError for fewer than one world or another mode, TypeError for a reward that is no function, UnknownTask,
        UnsupportedWorld, and WorldError if a task's file is wrong."""
        check_render_mode(render_mode)
        if max_episode_steps is not None and max_episode_steps < 1:
            raise ValueError(f"an episode has at least one step, not {max_episode_steps}")
        found = resolve_task(task, self.default_task)
        found = found if case is None else found.on(case)
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {
            **TaskEnv.metadata,
            "render_fps": round(1.0 / found.step_time),
            "autoreset_mode": self.autoreset_mode,
        }
        self.num_envs = num_envs
        self.render_mode = render_mode
        self.batch = BatchEnv(found, num_envs, reward=reward, autoreset=False)
        self.single_observation_space = self.batch.observation_space
        self.single_action_space = self.batch.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._names = np.array([each.name for each in self.batch.cases], dtype=object)
        self._most_steps = max_episode_steps
        self._elapsed = np.zeros(num_envs, dtype=np.int64)
        self._over = np.ones(num_envs, dtype=np.bool_)
        self._is_begun = False
        self._observations: ObservationArray = np.zeros(self.observation_space.shape or (), dtype=np.float32)
        self._picture: TerminalPicture | None = None
        self._spec: EnvSpec | None = None

    @property
    def spec(self) -> EnvSpec | None:
        """What ``gymnasium.make_vec`` made it by, with the steps after which an episode is over."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = with_step_limit(spec, self._most_steps or self.batch.task.max_steps)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ObservationArray, dict[str, Any]]:
        """Begins new episodes. ``seed``: of the first world, the others have the numbers that follow; or one for each.
        ``options``: ``case``, the name of the case that they run, and ``reset_mask`` (num_envs,), which worlds alone begin anew.

        Raises ValueError and TypeError for other seeds, masks and options."""
        check_options(options, "case", "reset_mask")
        which = np.flatnonzero(self._check_mask((options or {}).get("reset_mask")))
        seeds = self._seeds(seed)
        number = case_number(self.batch.task, (options or {}).get("case"))
        cases = None if number is None else np.full(self.num_envs, number)
        self._observations = self._observations.copy()
        self._observations[which] = self.batch.reset_worlds(
            which, seeds=[seeds[world] for world in which], cases=cases
        )
        self._elapsed[which] = 0
        self._over = self._over.copy()
        self._over[which] = False
        self._is_begun = True
        has_begun = np.zeros(self.num_envs, dtype=np.bool_)
        has_begun[which] = True
        self._paint_first_world()
        return self._observations.copy(), self._case_info(has_begun)

    def _seeds(self, seed: int | Sequence[int | None] | None) -> list[int | None]:
        if isinstance(seed, (int, np.integer)):
            return [int(seed) + world for world in range(self.num_envs)]
        if seed is not None:
            if len(seed) != self.num_envs:
                raise ValueError(f"{self.num_envs} environments need as many seeds, not {len(seed)}")
            return [None if each is None else int(each) for each in seed]
        if self._is_begun:
            return [None] * self.num_envs
        chance: list[int | None] = np.random.default_rng().integers(2**31, size=self.num_envs).tolist()
        return chance

    def _check_mask(self, mask: object) -> BoolArray:
        if mask is None:
            return np.ones(self.num_envs, dtype=np.bool_)
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            raise TypeError("reset_mask must be an array of numpy.bool_")
        if mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(
                f"reset_mask must have the shape ({self.num_envs},), and choose at least one environment"
            )
        if not self._is_begun and not mask.all():
            raise gymnasium.error.ResetNeeded("the first reset() must be of all environments")
        return mask

    def step(
        self, actions: ActionArray
    ) -> tuple[ObservationArray, FloatArray, BoolArray, BoolArray, dict[str, Any]]:
        """Every world does one step. ``info`` has what a single environment's has, an array for each key, and beside it a mask
        of the worlds for which it holds."""
        if not self._is_begun:
            raise gymnasium.error.ResetNeeded("call reset() before the first step()")
        if self.autoreset_mode is AutoresetMode.DISABLED and self._over.any():
            raise gymnasium.error.ResetNeeded(
                f"the episode of environment {int(np.flatnonzero(self._over)[0])} is over: call reset() with a reset_mask"
            )
        step = self.batch.step(np.asarray(actions))
        begun = self._over  # in the mode NEXT_STEP these begin their next episodes now
        self._elapsed = np.where(begun, 0, self._elapsed + 1)
        terminated = step.terminated & ~begun
        truncated = step.truncated & ~begun
        if self._most_steps is not None:
            truncated |= ~begun & (self._elapsed >= self._most_steps)
        over = terminated | truncated
        rewards = np.where(begun, 0.0, step.rewards).astype(np.float64)
        observations, info = step.observations, {}
        if self.autoreset_mode is AutoresetMode.SAME_STEP and over.any():
            info = self._final_info(step, np.flatnonzero(over))
            begun = over
            self._elapsed[over] = 0
        if begun.any():
            which = np.flatnonzero(begun)
            observations[which] = self.batch.reset_worlds(which)
        self._over = np.zeros_like(over) if self.autoreset_mode is AutoresetMode.SAME_STEP else over
        self._observations = observations
        self._paint_first_world()
        return observations.copy(), rewards, terminated, truncated, {**info, **self._info(step, ~begun)}

    def _case_info(self, known: BoolArray) -> dict[str, Any]:
        names = np.full(self.num_envs, None, dtype=object)
        names[known] = self._names[self.batch.state.case[known]]
        return {"case": names, "_case": known}

    def _info(self, step: BatchStep, went_on: BoolArray) -> dict[str, Any]:
        """What there is to know of each world after a step: of those that have just begun an episode only the case."""
        transition = step.transition
        found: dict[str, Any] = self._case_info(np.ones(self.num_envs, dtype=np.bool_))
        if not went_on.any():
            return found
        terms: dict[str, Any] = {}
        for name, values in step.terms.items():
            terms |= {name: np.where(went_on, values, 0.0) + 0.0, f"_{name}": went_on.copy()}
        found |= {"terms": terms, "_terms": went_on.copy()}
        found |= {"is_success": transition.reached & went_on, "_is_success": went_on.copy()}
        if self.batch.task.robots > 1:
            found |= {"adjacent": transition.adjacent & went_on, "_adjacent": went_on.copy()}
        ended = transition.ended & went_on
        if ended.any():
            outcomes = np.full(self.num_envs, None, dtype=object)
            for world in np.flatnonzero(ended).tolist():
                outcomes[world] = EpisodeOutcome.of(transition, world).value
            found |= {"outcome": outcomes, "_outcome": ended}
        return found

    def _final_info(self, step: BatchStep, which: IntArray) -> dict[str, Any]:
        """What was seen and is known of episodes that have ended, before their worlds begin the next ones."""
        info: dict[str, Any] = {}
        for world in which.tolist():
            final = step_info(self.batch, step, world)
            seen = step.observations[world].copy()
            info = self._add_info(info, {"final_obs": seen, "final_info": final}, world)
        return info

    # Gymnasium's other vector environments have these three; here there are no single environments to ask.

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """What ``render`` returns for each world, or an attribute of each, as ``get_attr`` has it.

        Raises AttributeError for another method."""
        if name != "render":
            return self.get_attr(name)
        return self.render(*args, **kwargs) or (None,) * self.num_envs

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """(num_envs,) an attribute of a single environment: of all worlds it is the same.

        Raises AttributeError where there is none of this name."""
        shared = {
            "task": self.batch.task,
            "render_mode": self.render_mode,
            "metadata": self.metadata,
            "spec": self.spec,
            "observation_space": self.single_observation_space,
            "action_space": self.single_action_space,
        }
        if name not in shared:
            raise AttributeError(f"{_NOT_ALONE} have no {quoted(name)}: {suggestion(name, shared)}{_ALONE}")
        return (shared[name],) * self.num_envs

    def set_attr(self, name: str, values: Any) -> None:
        """Raises AttributeError: the worlds share their attributes, which stay as they are."""
        raise AttributeError(f"{_NOT_ALONE} cannot be given {quoted(name)}{_ALONE}")

    def render(self) -> tuple[Any, ...] | None:
        """A picture of each world (height, width, 3) uint8 for ``rgb_array``, a text of each for ``ansi``; else None."""
        if self.render_mode is None or self.render_mode == "human" or not self._is_begun:
            return None
        scenes = (build_batch_scene(self.batch, world) for world in range(self.num_envs))
        return tuple(picture_of(scene, self.render_mode) for scene in scenes)

    def _paint_first_world(self) -> None:
        """Paints the first world in the terminal."""
        if self.render_mode != "human":
            return
        self._picture = self._picture or TerminalPicture(sys.stdout)
        self._picture.paint(build_batch_scene(self.batch, 0), picture_title(self.batch))


class TurnVectorEnv(BatchVectorEnv):
    """Many worlds of ``RobotKit/Turn-v0``."""

    default_task = TURN


class HallwayVectorEnv(BatchVectorEnv):
    """Many worlds of ``RobotKit/Hallway-v0``."""

    default_task = HALLWAY


class WheelchairsVectorEnv(BatchVectorEnv):
    """Many worlds of ``RobotKit/Wheelchairs-v0``."""

    default_task = WHEELCHAIRS
