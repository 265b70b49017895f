"""How a process that reads a submission begins: it limits and confines itself."""

from __future__ import annotations

import ctypes
import json
import resource
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import grader
import kit
from kit.extensions import ExtensionError, extensions, load
from kit.host.sandbox.grants import find_grants
from kit.host.sandbox.privileges import NO_CORE


def confine_before_reading(
    file: Path,
    scratch: str,
    drivers: Sequence[str] = (),
    *,
    kernel_modules: Sequence[str] = ("kernels", "grids"),
    beside: Sequence[str] = (),
) -> None:
    """Confines this process before it reads a file that was handed in.

    ``kernel_modules``: those of ``kit.kernels`` that it will use. ``beside``: other paths that it will read.
    """
    # Only here: a world that cannot be read needs no numba, and a student's own check is not confined.
    from grader.assignment import TEACHERS_STEMS
    from kit.host.sandbox.confinement import confine_reader

    for device in extensions("devices").values():  # of the packages that the assignment names
        with suppress(ExtensionError):
            load(device)
    granted = find_grants([file.parent])
    own = [
        str(entry)
        for package in (kit, grader)
        for entry in Path(package.__path__[0]).iterdir()
        if entry.name not in ("data", "templates")  # where an installation has lessons and solutions
    ]
    programs = [
        str(module)
        for driver in drivers
        for module in Path(driver).parent.glob("*.py")
        if not module.stem.startswith(TEACHERS_STEMS) or str(module) == driver
    ]
    # Imported now, since a kernel whose cache cannot be written when it is made has none.
    kernels = [import_module(f"kit.kernels.{name}") for name in kernel_modules]
    jitted = [made for module in kernels for made in vars(module).values() if hasattr(made, "enable_caching")]
    # Where nothing may be written, not even by the user, a kernel has no cache on disk.
    caches = [made._cache for made in jitted if hasattr(made._cache, "cache_path") and made._cache.cache_path]
    compiled = {each.cache_path for each in caches}
    for kind in {type(each) for each in caches}:
        # What is compiled here must not be run by others, and numba, which has no switch for it, fails where it cannot write.
        kind.save_overload = lambda *_: None
    python = [sys.executable, f"{sys.prefix}/pyvenv.cfg"]  # for the driver
    packages = [*kit.__path__, *grader.__path__]
    folders = [*granted.listed, *packages, *{str(Path(each).parent) for each in packages}]
    readable = [*granted.readable, *python, *own, *programs, *beside, *compiled, "/proc"]
    confine_reader(readable, folders, [scratch])


def send_answer(answers: Any, answer: dict[str, Any]) -> None:
    """Writes one line of JSON."""
    answers.write(json.dumps(answer) + "\n")
    answers.flush()


def limit_memory(size: int, *, for_good: bool = False) -> None:
    """Limits the address space to ``size`` bytes; ``for_good``: never to be more again."""
    hard = size if for_good else resource.getrlimit(resource.RLIMIT_AS)[1]
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (size, hard))


def limit_resources() -> None:
    """Makes the process end with its parent, and leave no core file."""
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, ctypes.c_ulong(9))  # PR_SET_PDEATHSIG, SIGKILL
    resource.setrlimit(resource.RLIMIT_CORE, (NO_CORE, NO_CORE))
