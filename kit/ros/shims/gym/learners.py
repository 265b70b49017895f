"""stable-baselines3's check of an environment, for the environments of that time."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any

import shimmy

from gym.core import Env
from kit.ros.execution.context import log_as_kit

CHECKER = "stable_baselines3.common.env_checker"


def adapt_checker() -> None:
    """Makes ``check_env`` check a gym environment in the wrapped form that a learner uses."""
    sys.meta_path.insert(0, _CheckerFinder())


class _CheckerFinder:
    """An import finder and loader that loads the checker's module as usual, then replaces one function."""

    def __init__(self) -> None:
        self._loader: Any = None

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name != CHECKER:
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None:
            self._loader, spec.loader = spec.loader, self
        return spec

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__.loader = module.__loader__ = self._loader
        self._loader.exec_module(module)
        module.check_env = _checking(module.check_env)


def _checking(check: Callable[..., None]) -> Callable[..., None]:
    def check_env(env: Any, *arguments: Any, **options: Any) -> None:
        """Checks as stable-baselines3 does, but only warns of a gym environment's problems, since most rules are newer."""
        if not isinstance(env, Env):
            check(env, *arguments, **options)
            return
        try:
            check(shimmy.GymV21CompatibilityV0(env=env), *arguments, **options)
        except AssertionError as problem:
            log_as_kit(f"today's check_env objects, the one of that time did not: {problem}", is_warning=True)

    return check_env
