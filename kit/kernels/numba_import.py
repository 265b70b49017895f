"""How numba is imported: without what kernels do not need, deaf to the current folder, and with its progress heard."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import chdir, contextmanager, nullcontext
from pathlib import Path
from typing import Any

from kit.kernels.compilation_progress import PROGRESS

NUMBA_SETTINGS = Path(".numba_config.yaml")
"""numba reads it in the current folder, at its import and whenever it compiles. It names the cache, whose files can run code,
and the current folder may be a student's."""
UNUSED = ("scipy", "cffi")
"""What numba would import for linear algebra and for C functions that cffi declares, of which kernels have neither: with all that
these import, they take 14 MB of every drive (``tests/benchmarks/memory.py``)."""


@contextmanager
def _hide_packages(names: Sequence[str]) -> Iterator[None]:
    """Has packages be as if they were not installed, unless they are imported already."""
    hidden = [name for name in names if name not in sys.modules]
    sys.modules.update(dict.fromkeys(hidden))  # type: ignore[arg-type] # None is Python's own mark for it
    try:
        yield
    finally:
        for name in hidden:
            sys.modules.pop(name, None)


# Not compiled, kernels take a hundred times as long, and what a budget of time allows depends on the caller's environment.
os.environ.pop("NUMBA_DISABLE_JIT", None)
with _hide_packages(UNUSED), chdir("/") if NUMBA_SETTINGS.exists() else nullcontext():
    import numba as numba
    from numba.core import caching as caching
    from numba.core import ccallback as ccallback
    from numba.core import config, event
    from numba.core.registry import cpu_target
    from numba.core.runtime.nrt import rtsys

config._config_fname = ""  # no file has this name

UNTYPED: Any = numba.core
"""numba's own modules, which have no types."""


def prepare_loading() -> None:
    """What machine code from the disk needs: the counters of references to its arrays."""
    rtsys.initialize(cpu_target.target_context)


def prepare_compiling() -> None:
    """Imports what only a compiler needs, which takes as long as the rest of numba."""
    with _hide_packages(UNUSED):
        cpu_target.target_context.refresh()


class _ProgressListener(event.Listener):
    def on_start(self, event: Any) -> None:
        PROGRESS.begin(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event: Any) -> None:
        PROGRESS.end()


UNTYPED.event.register("numba:compile", _ProgressListener())
