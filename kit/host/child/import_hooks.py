"""Changes a module of a library when and if the program imports it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from importlib.abc import Loader


def on_import(name: str, change: Callable[[ModuleType], object]) -> None:
    """Calls ``change`` with a module: now if it has been imported, else as soon as it has been, in the order of the calls."""
    if name in sys.modules:
        change(sys.modules[name])
        return
    for finder in sys.meta_path:
        if isinstance(finder, _ImportHook) and finder.name == name:
            finder.changes.append(change)
            return
    sys.meta_path.insert(0, _ImportHook(name, change))


class _ImportHook:
    """Finder and loader of one module, which changes it once it is loaded."""

    def __init__(self, name: str, change: Callable[[ModuleType], object]) -> None:
        self.name, self.changes = name, [change]
        self._loader: Loader | None = None

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name != self.name:
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
        for change in self.changes:
            change(module)
