"""Floor 0: all jitted code, and the arrays that it takes.

``from kit.kernels import kernels`` costs nothing: the jitted code and numba are imported with the first kernel that is
used. A quarter of a second is saved wherever a world is only read.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


class _KernelsOnDemand:
    """Stands for the module ``kit.kernels.kernels`` until a name of it is used, and then passes its names on."""

    def __getattr__(self, name: str) -> Any:
        # The import system's own lock makes this safe in threads.
        value = getattr(import_module("kit.kernels.kernels"), name)
        setattr(self, name, value)
        return value


def __getattr__(name: str) -> Any:
    """Returns the stand-in, as long as the module itself is not imported."""
    if name == "kernels":
        return _KERNELS
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


_KERNELS = _KernelsOnDemand()
