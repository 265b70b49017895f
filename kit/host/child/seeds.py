"""Seeds the student's random numbers: the same in every run with the same seed."""

from __future__ import annotations

import random
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from importlib.abc import Loader


def seed_random(seed: int) -> None:
    """Seeds ``random`` now, and ``numpy.random`` when and if the program imports it."""
    random.seed(seed)
    sys.meta_path.insert(0, _NumpySeeder(seed))


class _NumpySeeder:
    """Import hook (finder and loader) that seeds numpy's global generator once numpy is loaded."""

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._loader: Loader | None = None

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name != "numpy":
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.loader is not None:
            self._loader = spec.loader
            spec.loader = cast("Loader", self)
        return spec

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        assert self._loader is not None
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        assert self._loader is not None
        assert module.__spec__ is not None
        module.__spec__.loader = module.__loader__ = self._loader
        self._loader.exec_module(module)
        module.random.seed(self._seed % 2**32)
