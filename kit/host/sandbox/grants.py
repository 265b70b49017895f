"""Lists what a confined program may read: Python, installed packages, the kit's code for the child, its own folder.

The kit and the grader are installed packages too, and carry lessons with secret seeds, solutions and references.
So a folder that has them somewhere below is not granted as a whole: everything else in it is, one by one.
"""

from __future__ import annotations

import os
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

_SYSTEM: Final = (
    "/lib", "/lib32", "/lib64", "/usr/lib", "/usr/lib32", "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache",
    "/etc/localtime", "/usr/share/zoneinfo", "/sys/devices/system/cpu", "/dev/zero", "/dev/random", "/dev/urandom",
)  # fmt: skip
"""Shared libraries and what the C library looks at."""

_PACKAGE = Path(__file__).parents[2]
_KIT_PARTS: Final = (
    "__init__.py",
    "environment_ids.py",
    "geometry.py",
    "interruption.py",
    "part_file.py",
    "plain_files.py",
    "plain_text.py",
    "yaml_numbers.py",
    "yaml_slips.py",
    "host",
    "msg",
    "ros",
)
"""The parts of the kit that a student's process consists of, and all that these import of the kit."""
MAPPED_FILES: Final = "/proc/self/maps"
"""What this process has mapped into its memory, its shared libraries among it."""
_DISTRIBUTION: Final = "robot_learning_kit"
_INSTALLED: Final = ("kit", "grader")
_CHECKOUT: Final = (*_INSTALLED, "lessons", "tests")
"""Folders with something to hide in a checkout."""
_LIBRARY_NAMES: Final = ("site-packages", "dist-packages")


@dataclass(frozen=True, slots=True)
class ReadGrants:
    """Absolute paths. They may be links, and need not exist."""

    readable: tuple[str, ...] = ()
    """Files and folders, with everything below them."""
    listed: tuple[str, ...] = ()
    """Folders of which only names may be read: an import looks there for what it then finds in ``readable``."""
    hidden: tuple[str, ...] = ()
    """What lies in ``listed`` folders and must not be read, without links. All else in them is in ``readable``."""


def library_folders() -> list[str]:
    """Returns the folders of installed packages, without what ``.pth`` files add, such as a checkout."""
    return [path for path in sys.path if Path(path).name in _LIBRARY_NAMES]


def find_grants(folders: Iterable[Path]) -> ReadGrants:
    """Returns what a program may read that lies in the first of these folders and imports from the others."""
    global _last_installed
    searched = _searched_paths()
    if _last_installed is None or not _last_installed.is_current(searched):
        _last_installed = _find_installed(searched)
    installed = _last_installed.grants
    ours = [*(str(_PACKAGE / name) for name in _KIT_PARTS), *map(str, folders)]
    readable = tuple(dict.fromkeys((*map(os.path.abspath, ours), *installed.readable)))
    return ReadGrants(readable, tuple(dict.fromkeys((str(_PACKAGE), *installed.listed))), installed.hidden)


@dataclass(frozen=True, slots=True)
class _Installed:
    """What is granted of Python, the system's libraries and the installed packages, and when that was found."""

    searched: tuple[str, ...]
    grants: ReadGrants
    changed_ns: Mapping[str, int]
    """When each folder that was looked through was last changed [ns]."""

    def is_current(self, searched: tuple[str, ...]) -> bool:
        """Returns whether the same paths, looked through again, would give the same."""
        return self.searched == searched and all(
            _changed_ns(folder) == then for folder, then in self.changed_ns.items()
        )


_last_installed: _Installed | None = None
"""A class is graded by hundreds of processes, one after the other, and nothing is installed meanwhile."""


def _searched_paths() -> tuple[str, ...]:
    """Returns the paths of Python, the installed packages and the system's libraries."""
    python = [sysconfig.get_path("stdlib"), sysconfig.get_path("platstdlib"), f"{sys.base_prefix}/lib"]
    loader = [library for folder in loader_folders() for library in _shared_libraries(folder)]
    return tuple(dict.fromkeys(map(os.path.abspath, [*python, *library_folders(), *loader, *_SYSTEM])))


def loader_folders() -> list[str]:
    """Returns the folders of LD_LIBRARY_PATH from which this very Python has loaded a library: a computing cluster keeps them
    there. The variable may name anything else, such as a workspace, and grants nothing of that."""
    named = [path for path in os.environ.get("LD_LIBRARY_PATH", "").split(":") if os.path.isabs(path)]
    if not named:
        return []
    with suppress(OSError), open(MAPPED_FILES) as mapped:
        loaded = {os.path.dirname(line.split(maxsplit=5)[-1].strip()) for line in mapped if ".so" in line}
        return [path for path in named if os.path.realpath(path) in loaded]
    return []


def _shared_libraries(folder: str) -> list[str]:
    return [f"{folder}/{name}" for name in sorted(_names_in(folder)) if ".so" in name]


def _find_installed(searched: tuple[str, ...]) -> _Installed:
    hidden = frozenset(_hidden_paths())
    readable: list[str] = []
    listed: list[str] = []
    libraries = dict.fromkeys((*library_folders(), *_libraries_of_python()))
    changed_ns = {folder: _changed_ns(folder) for folder in libraries}
    for path in searched:
        _add_path(path, os.path.realpath(path), hidden, readable, listed)
    changed_ns |= {folder: _changed_ns(folder) for folder in listed if folder not in changed_ns}
    grants = ReadGrants(tuple(dict.fromkeys(readable)), tuple(dict.fromkeys(listed)), tuple(sorted(hidden)))
    return _Installed(searched, grants, changed_ns)


def _changed_ns(folder: str) -> int:
    try:
        return os.stat(folder).st_mtime_ns
    except OSError:
        return 0


def _add_path(path: str, real: str, hidden: frozenset[str], readable: list[str], listed: list[str]) -> None:
    """Adds a path, or what is in it without what is hidden. ``real``: the path without links."""
    if any(real == each or real.startswith(f"{each}/") for each in hidden):
        return
    if not any(each.startswith(f"{real}/") for each in hidden):
        readable.append(path)
        return
    listed.append(path)
    with suppress(OSError):  # the program cannot read it either
        for entry in sorted(os.scandir(real), key=lambda entry: entry.name):
            inner = os.path.realpath(entry.path) if entry.is_symlink() else entry.path
            _add_path(f"{path}/{entry.name}", inner, hidden, readable, listed)


def _hidden_paths() -> Iterator[str]:
    """Yields the real paths of every installed copy of the kit and the grader, and of the checkouts they come from."""
    for folder in dict.fromkeys((*library_folders(), *_libraries_of_python())):
        for name in _names_in(folder):
            if name in _INSTALLED or _DISTRIBUTION in name.lower().replace("-", "_"):
                yield from _link_and_target(folder, name)
            if name.endswith(".pth") and _DISTRIBUTION in name.lower():
                for checkout in _pth_targets(f"{folder}/{name}"):
                    yield from (path for each in _CHECKOUT for path in _link_and_target(checkout, each))
    root = _PACKAGE.parent
    for name in _INSTALLED if root.name in _LIBRARY_NAMES else _CHECKOUT:
        yield from _link_and_target(str(root), name)


def _libraries_of_python() -> list[str]:
    """Returns where the Python that a virtual environment is made of keeps its packages."""
    return [f"{sysconfig.get_path('stdlib')}/{name}" for name in _LIBRARY_NAMES]


def _link_and_target(folder: str, name: str) -> Iterator[str]:
    """Yields a path and, if it is a link, its target."""
    yield f"{os.path.realpath(folder)}/{name}"
    yield os.path.realpath(f"{folder}/{name}")


def _names_in(folder: str) -> list[str]:
    try:
        return os.listdir(folder)
    except OSError:
        return []


def _pth_targets(file: str) -> list[str]:
    """Returns the folders that a ``.pth`` file adds."""
    try:
        lines = Path(file).read_text(errors="replace").splitlines()
    except OSError:
        return []
    return [line for line in lines if line.startswith("/") and os.path.isdir(line)]
