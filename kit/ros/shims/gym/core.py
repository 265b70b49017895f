"""Environments and wrappers as gym 0.21 has them."""

from __future__ import annotations

from typing import Any, ClassVar

Step = tuple[Any, float, bool, dict[str, Any]]
"""Observation, reward, whether the episode is over, and further information."""


class Env:
    """``reset() -> observation``, ``step(action) -> observation, reward, done, info``."""

    metadata: ClassVar[dict[str, Any]] = {"render.modes": []}
    reward_range = (-float("inf"), float("inf"))
    spec: Any = None
    action_space: Any = None
    observation_space: Any = None

    def step(self, action: Any) -> Step:
        raise NotImplementedError

    def reset(self) -> Any:
        raise NotImplementedError

    def render(self, mode: str = "human") -> Any:
        raise NotImplementedError

    def close(self) -> None:
        """Nothing to do."""

    def seed(self, seed: int | None = None) -> Any:
        """Old environments take their seed here; this one has no use for it."""

    @property
    def unwrapped(self) -> Any:
        return self

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Wrapper(Env):
    """Wraps an environment; attributes it does not define are those of the environment."""

    def __init__(self, env: Any) -> None:
        self.env = env

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.env, name)

    @property
    def action_space(self) -> Any:
        return self.env.action_space

    @property
    def observation_space(self) -> Any:
        return self.env.observation_space

    @property
    def unwrapped(self) -> Any:
        return self.env.unwrapped

    def step(self, action: Any) -> Step:
        return self.env.step(action)

    def reset(self) -> Any:
        return self.env.reset()

    def render(self, mode: str = "human") -> Any:
        return self.env.render(mode)

    def close(self) -> None:
        self.env.close()

    def seed(self, seed: int | None = None) -> Any:
        return self.env.seed(seed)


class ObservationWrapper(Wrapper):
    """Subclasses transform observations in ``observation``."""

    def reset(self) -> Any:
        return self.observation(self.env.reset())

    def step(self, action: Any) -> Step:
        observation, reward, done, info = self.env.step(action)
        return self.observation(observation), reward, done, info


class RewardWrapper(Wrapper):
    """Subclasses transform rewards in ``reward``."""

    def step(self, action: Any) -> Step:
        observation, reward, done, info = self.env.step(action)
        return observation, self.reward(reward), done, info


class ActionWrapper(Wrapper):
    """Subclasses transform actions in ``action``."""

    def step(self, action: Any) -> Step:
        return self.env.step(self.action(action))
