"""Wraps gym environments for gymnasium; stable-baselines3 imports this module when it is given a gym environment."""

from __future__ import annotations

from typing import Any, ClassVar

import gymnasium


class GymV21CompatibilityV0(gymnasium.Env):
    """Wraps ``env``: gym 0.21's ``reset`` and ``step`` behind gymnasium's."""

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}

    def __init__(
        self,
        env_id: str | None = None,
        make_kwargs: Any = None,
        env: Any = None,
        render_mode: str | None = None,
    ) -> None:
        if env is None:
            raise ImportError("gym is not installed, so there is no environment to make by its name")
        self.gym_env = env
        self.action_space = env.action_space
        self.observation_space = env.observation_space
        self.render_mode = render_mode

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        if seed is not None and hasattr(self.gym_env, "seed"):
            self.gym_env.seed(seed)
        return self.gym_env.reset(), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        observation, reward, done, info = self.gym_env.step(action)
        truncated = bool(info.get("TimeLimit.truncated", False))
        return observation, float(reward), bool(done) and not truncated, truncated, info

    def render(self) -> Any:
        return self.gym_env.render()

    def close(self) -> None:
        self.gym_env.close()


class GymV26CompatibilityV0(GymV21CompatibilityV0):
    """The same for gym 0.26, whose ``reset`` and ``step`` are gymnasium's already."""

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        gymnasium.Env.reset(self, seed=seed)
        return self.gym_env.reset(seed=seed, options=options)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        return self.gym_env.step(action)
