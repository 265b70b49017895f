"""Floor 0: all jitted code, and the arrays that it takes.

``from kit.kernels import kernels`` costs nothing: the jitted code and numba are imported with the first kernel that is
used. A quarter of a second is saved wherever a world is only read.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


class _KernelsOnDemand:
    """Stands for a module of kernels until a name of it is used, and then passes its names on."""

    def __init__(self, module: str) -> None:
        self._module = module

    def __getattr__(self, name: str) -> Any:
        # The import system's own lock makes this safe in threads.
        value = getattr(import_module(self._module), name)
        setattr(self, name, value)
        return value


def __getattr__(name: str) -> Any:
    """Returns the stand-in, as long as the module itself is not imported."""
    if name in _ON_DEMAND:
        return _ON_DEMAND[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


_ON_DEMAND = {
    name: _KernelsOnDemand(f"kit.kernels.{name}")
    for name in ("batch_step", "compilation", "kernels", "grids", "world_kernels")
}
