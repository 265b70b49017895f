"""What a student's process is started with: its command, its environment, its file and package, and its seed.

A process is a cold start, 0.09 s of processor time, unless the caller has it forked (``kit.host.warm_start``): the check of
one's own program does. Where other people's programs are run, no process is kept warm that could hold what they may not read.
"""

from __future__ import annotations

import hashlib
import os
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Final, Protocol, TypeAlias

from kit.blas import blas_environment
from kit.host.failure import StudentCodeError, unreadable_file
from kit.host.sandbox import bubblewrap
from kit.host.sandbox.grants import ReadGrants, find_grants, library_folders, loader_folders
from kit.host.sandbox.limits import KIB
from kit.host.sandbox.sandbox_config import Level, SandboxConfig
from kit.host.wire import Json

MAX_SOURCE: Final = 512 * KIB
"""Bytes of a student's file."""
ROS_DISTRO: Final = "jazzy"
"""The distribution that programs read in their environment: the one whose messages and names the kit follows."""

_START: Final = (
    f"import os, sys; sys.path.insert(0, {str(Path(__file__).parents[2])!r}); "
    "from kit.host.child import supervisor; del sys.path[0]; os._exit(supervisor.run())"
)
"""Starts the child of the kit that this file is part of; nothing beside the kit becomes importable. Not ``sys.exit``: it
would run the student's destructors and exit handlers, and wait for threads."""


@dataclass(frozen=True, slots=True)
class PackageProgram:
    """A program of a package, with what an installation would provide: entry point, imports, working folder, environment."""

    folder: Path
    """The package's folder: messages name files relative to it."""
    cwd: Path | None
    """Its working folder; None: one of its own."""
    environment: Mapping[str, str]
    entry: str | None = None
    """``package.module:function``; None: the file itself is run."""
    imports: tuple[Path, ...] = ()
    """Folders from which modules are imported, before the installed libraries."""
    interfaces: Mapping[str, Path] = field(default_factory=dict)
    """The folders of the packages whose messages, services and actions it may use, by name."""
    is_controller: bool = False
    """Whether the file is run as a controller: one that only has a ``main`` or a class of nodes is run by that."""

    def to_start_fields(self) -> dict[str, Json]:
        """Returns the fields of the ``start`` frame."""
        return {
            "folder": str(self.folder),
            "is_controller": self.is_controller,
            **({} if self.cwd is None else {"cwd": str(self.cwd)}),
            "environment": dict(self.environment),
            "entry": self.entry,
            "imports": [str(path) for path in self.imports],
            "interfaces": {name: str(path) for name, path in self.interfaces.items()},
        }


def child_seed(seed: int) -> int:
    """Returns the seed of a student's random numbers, 0 to 2**63 - 1, for the seed of a run.

    It is one-way: a student's program can read its own seed, and the seed of the run may be a secret.
    """
    digest = hashlib.sha256(b"student" + str(seed).encode()).digest()
    return int.from_bytes(digest[:8], "big") >> 1


class StartedProcess(Protocol):
    """What is used of a ``subprocess.Popen``."""

    @property
    def pid(self) -> int: ...

    @property
    def stdout(self) -> IO[bytes] | None: ...

    @property
    def stderr(self) -> IO[bytes] | None: ...

    def wait(self, timeout: float | None = None) -> int: ...

    def kill(self) -> None: ...


StartProcess: TypeAlias = Callable[..., StartedProcess]
"""Takes what ``subprocess.Popen`` does."""


def start_cold(command: list[str], **options: object) -> StartedProcess:
    """Starts an interpreter anew."""
    process: subprocess.Popen[bytes] = subprocess.Popen(command, **options)  # type: ignore[call-overload] # as they came
    return process


STARTS: Final[list[StartProcess]] = [start_cold]
"""The last one starts students' processes."""


@contextmanager
def started_by(start: StartProcess) -> Iterator[None]:
    """Has all students' processes of this one be started so."""
    STARTS.append(start)
    try:
        yield
    finally:
        STARTS.pop()


def read_program(file: Path) -> dict[str, Json]:
    """Reads the student's file, once: this version runs, whatever is saved later."""
    try:
        # A named pipe would have us wait for ever.
        with open(os.open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as opened:
            if not stat.S_ISREG(os.fstat(opened.fileno()).st_mode):
                raise StudentCodeError(unreadable_file(file, "not a file"))
            source = opened.read(MAX_SOURCE + 1)
    except OSError as problem:
        raise StudentCodeError(unreadable_file(file, problem.strerror or "unreadable")) from None
    if len(source) > MAX_SOURCE:
        raise StudentCodeError(unreadable_file(file, f"larger than {MAX_SOURCE // KIB} KiB"))
    return {"file": str(file), "source": source.decode("latin-1"), "libraries": library_folders()}


def interpreter_command() -> list[str]:
    """Returns the command of an interpreter without anything of the user's: no site, user site or ``sys.path[0]``.

    ``-I`` would also ignore PYTHONHASHSEED, and so let the order of a set differ from run to run; the
    environment is ours anyway.
    """
    return [sys.executable, "-s", "-S", "-P", "-c", _START]


def start_command(config: SandboxConfig) -> list[str]:
    """Returns the command that starts a process with this confinement."""
    if config.in_bubblewrap:
        return bubblewrap.wrap_command(
            interpreter_command(), config.file_tree, config.scratch, config.limits.scratch
        )
    return interpreter_command()


def process_environment(scratch: str) -> dict[str, str]:
    """Returns the whole environment of a student's process: the same everywhere."""
    fixed = {
        "PATH": "/usr/bin:/bin",
        "HOME": scratch,
        "TMPDIR": scratch,
        "LANG": "C.UTF-8",
        "PYTHONHASHSEED": "0",
        "PYTHONUTF8": "1",
        "ROS_VERSION": "2",
        "ROS_PYTHON_VERSION": "3",
        "ROS_DISTRO": ROS_DISTRO,
        # One thread each: more would differ between machines, and each reserves memory.
        "OMP_NUM_THREADS": "1",
        "MKL_NUM_THREADS": "1",
        **blas_environment(),
    }
    # Where a computing cluster keeps the libraries of the very Python that runs this.
    library_path = ":".join(loader_folders())
    return fixed | ({"LD_LIBRARY_PATH": library_path} if library_path else {})


def read_grants(level: Level, file: Path, package: PackageProgram | None) -> ReadGrants:
    """Returns what a program may read: with its folder, its package and what that imports from."""
    if level == Level.LIMITED:  # nothing is kept from it
        return ReadGrants()
    more = () if package is None else (package.folder, *package.imports, *package.interfaces.values())
    return find_grants((file.parent, *more))
