"""The process that reads and runs a world: one request per line on standard input, one answer per line on standard output.

No program of a student's runs in it, but a world may be too large or too slow: then the process is ended. And what reads
it may have mistakes: from level 1 on the process can open no file but Python, the kit, the world's folder and the
assignment's drivers, write to its own folder alone, and reach neither the network nor other processes.
"""

from __future__ import annotations

import ctypes
import json
import os
import resource
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from importlib import import_module
from pathlib import Path
from typing import Any

import grader
import kit
from grader.evidence.world.facts import WorldFacts, WorldRunSpec
from kit.extensions import ExtensionError, extensions, load
from kit.host.sandbox.grants import find_grants
from kit.world.documents import AllowedRoot, UnusableFile, WorldDocuments
from kit.world.problems import ProblemCollector, WorldError
from kit.world.records import SourceLocation, World


def main() -> None:
    """Reads the world named on the command line, then makes one run for each line."""
    path, memory, is_confined, scratch, *drivers = sys.argv[1:]
    file = Path(path)
    limit_resources()
    limit_memory(int(memory))
    load_devices()
    if is_confined:
        confine_before_reading(file, scratch, drivers)
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # other output must not mix with the answers
    facts, world = _read_world(file, int(memory))
    send_answer(answers, asdict(facts))
    from grader.evidence.world.world_run import run_world  # only now: a world that cannot be read is not run

    for line in sys.stdin:
        send_answer(answers, asdict(run_world(_there(world), WorldRunSpec(**json.loads(line)))))


def load_devices() -> None:
    """Loads the devices of the packages that the assignment names, which this process cannot open once it is confined."""
    for each in extensions("devices").values():
        with suppress(ExtensionError):
            load(each)


def _read_world(file: Path, memory: int) -> tuple[WorldFacts, World | None]:
    """Reads a world; of one whose main file is no mapping nothing else is read, and no simulator loaded for it."""
    documents = WorldDocuments(AllowedRoot.containing(file), {}, ProblemCollector())
    with suppress(UnusableFile):
        try:  # what is too much to read ends the reading at once
            if documents.section(documents.allowed_root.path_inside(file), SourceLocation(file)) is None:
                documents.problems.raise_if_any()
        except WorldError as error:
            return WorldFacts.of_unreadable(error, file), None
    limit_memory(resource.getrlimit(resource.RLIMIT_AS)[1])  # the simulator's own code is not the world's
    from grader.evidence.world.world_reading import read_world_facts

    limit_memory(memory, for_good=True)
    return read_world_facts(file)


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
    from grader.ci import TEACHERS_STEMS
    from kit.host.sandbox.confinement import confine_reader

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


def _there(world: World | None) -> World:
    assert world is not None, "a world that cannot be read is not run"
    return world


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
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


if __name__ == "__main__":
    main()
