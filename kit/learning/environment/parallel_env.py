"""The robots of a task as agents of their own: an environment of PettingZoo (needs the extra ``pettingzoo``)."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from kit.installation import install_command
from kit.learning.environment.env import Observation, TaskEnv, check_options, resolve_task
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.catalogue import WHEELCHAIRS
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.reward import RewardFunction
from kit.plain_text import join_names, quoted, suggestion

try:
    from pettingzoo import ParallelEnv
except ImportError:
    raise ImportError(
        f"PettingZoo is not installed. To have it, type: {install_command('pettingzoo')}"
    ) from None


class RobotsParallelEnv(ParallelEnv):
    """One world of a task in which every robot is an agent, named as its model is.

    Each sees its own numbers and does one action of the task's table, or of its continuous ones. All get the same reward,
    and the episode ends for all at the same time: the robots of a task work together.

    >>> env = kit.RobotsParallelEnv("wheelchairs")
    >>> observations, infos = env.reset(seed=1)
    >>> sorted(observations)
    ['left', 'right']
    >>> actions = {agent: env.action_space(agent).sample() for agent in env.agents}
    >>> observations, rewards, terminations, truncations, infos = env.step(actions)
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "robot_kit",
        "render_modes": TaskEnv.metadata["render_modes"],
    }

    def __init__(
        self,
        task: LearningTask | Path | str | None = None,
        *,
        case: str | None = None,
        reward: RewardFunction | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Takes the arguments of ``TaskEnv``; the default task is ``wheelchairs``."""
        found = resolve_task(task, WHEELCHAIRS)
        self._env = TaskEnv(found, case=case, reward=reward, render_mode=render_mode)
        self.task = found = self._env.task
        self.render_mode = render_mode
        self.possible_agents: list[str] = list(found.robots_on(found.map_cases()[0][0]))
        self.agents: list[str] = []
        self._actions = found.actions
        observed = found.observation.space(1)
        self.observation_spaces = dict.fromkeys(self.possible_agents, observed)
        self.action_spaces: dict[str, spaces.Space[Any]] = {
            agent: found.actions.space(1) for agent in self.possible_agents
        }

    def __repr__(self) -> str:
        """``RobotsParallelEnv(wheelchairs: left, right)``"""
        return f"{type(self).__name__}({self.task.name}: {', '.join(self.possible_agents)})"

    def observation_space(self, agent: str) -> spaces.Box:
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Observation], dict[str, dict[str, Any]]]:
        """Begins an episode. ``options={"case": name}``: on this case, instead of the next one in turn. Warns of other options."""
        self.agents = list(self.possible_agents)
        known = {name: value for name, value in (options or {}).items() if name == "case"}
        try:
            check_options(options, "case")
        except ValueError as error:  # PettingZoo's own test gives options that are none, and wants no error
            warnings.warn(str(error), stacklevel=2)
        seen, info = self._env.reset(seed=seed, options=known)
        return self._split_observation(seen), {agent: dict(info) for agent in self.agents}

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[
        dict[str, Observation],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """The robots do one step. KeyError if one of them has no action, or what is no robot has one."""
        agents = list(self.agents)
        seen, reward, terminated, truncated, info = self._env.step(self._join_actions(actions))
        if terminated or truncated:
            self.agents = []
        return (
            {agent: part for agent, part in self._split_observation(seen).items() if agent in agents},
            dict.fromkeys(agents, reward),
            dict.fromkeys(agents, terminated),
            dict.fromkeys(agents, truncated),
            {agent: dict(info) for agent in agents},
        )

    def render(self) -> Any:
        return self._env.render()

    def close(self) -> None:
        self._env.close()

    def state(self) -> NDArray[Any]:
        """Returns what all robots see together, as one agent of Gymnasium's environment would."""
        return self._seen.copy()

    def _split_observation(self, seen: NDArray[Any]) -> dict[str, Observation]:
        """Splits an observation by robot: of every frame its own numbers."""
        self._seen = seen
        spec = self.task.observation
        parts = seen.reshape(spec.frames, len(self.possible_agents), spec.frame_size)
        return {agent: parts[:, number].ravel() for number, agent in enumerate(self.possible_agents)}

    def _join_actions(self, actions: dict[str, Any]) -> Any:
        """One action of all robots, from those of each."""
        for agent in actions:
            if agent not in self.possible_agents:
                raise KeyError(
                    f"there is no agent {quoted(str(agent))}: {suggestion(str(agent), self.possible_agents)}"
                )
        if without := [agent for agent in self.possible_agents if agent not in actions]:
            raise KeyError(f"every agent needs an action: there is none of {join_names(without)}")
        each = [np.asarray(actions[agent]) for agent in self.possible_agents]
        if not isinstance(self._actions, DiscreteActions):
            return np.concatenate(each)
        choices = np.array([each], dtype=np.int64)
        return self._actions.encode(choices, len(each))[0]
