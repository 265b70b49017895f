"""Registers the learning environments with Gymnasium, without importing Gymnasium or anything heavy of the kit.

``import kit`` calls ``register_when_imported``, so that ``gymnasium.make("RobotKit/Turn-v0")`` works in whichever order
the two are imported. Releases of Gymnasium that load plugins call ``register`` by the entry point ``gymnasium.envs``.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.abc import Loader, MetaPathFinder
else:
    # importlib.abc imports pathlib, tempfile and more, which every start of a student's node would pay for.
    Loader = MetaPathFinder = object

ENVIRONMENTS = ("Turn", "Hallway", "Wheelchairs")
REGISTRATION_MODULE = "gymnasium.envs.registration"


def register() -> None:
    """Registers ``RobotKit/Turn-v0``, ``RobotKit/Hallway-v0`` and ``RobotKit/Wheelchairs-v0``; twice does no harm."""
    from gymnasium.envs.registration import register as register_environment
    from gymnasium.envs.registration import registry

    for name in ENVIRONMENTS:
        identifier = f"RobotKit/{name}-v0"
        if identifier not in registry:
            register_environment(
                identifier,
                entry_point=f"kit.learning.environment.env:{name}Env",
                vector_entry_point=f"kit.learning.environment.vector_env:{name}VectorEnv",
            )


def register_when_imported() -> None:
    """Registers the environments now if Gymnasium is loaded, else as soon as it is."""
    if REGISTRATION_MODULE in sys.modules:
        register()
    elif not any(isinstance(finder, _RegistrationFinder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _RegistrationFinder())


class _RegistrationFinder(MetaPathFinder):
    """Finds Gymnasium's registry as usual, and has the environments registered once it is loaded."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != REGISTRATION_MODULE:
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = _RegisteringLoader(spec.loader)
        return spec


class _RegisteringLoader(Loader):
    """Loads a module as ``loader`` does, then registers the environments."""

    def __init__(self, loader: Loader) -> None:
        self._loader = loader

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        self._loader.exec_module(module)
        register()
