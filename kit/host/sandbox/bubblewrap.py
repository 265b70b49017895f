"""Reaches level 2 by bubblewrap, where a process may not make namespaces itself and that program may.

Some systems let only programs that they know make user namespaces. The tree of files is the same as that of
``namespaces``; Landlock, the filter of system calls and the limits are set inside, as everywhere. Manual: bwrap(1).
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final

from kit.host.sandbox.namespaces import FileTree, plan_mounts

PROGRAM: Final = "bwrap"
TRIAL_S: Final = 20.0
"""How long a trial may take [s]."""

_KIT: Final = str(Path(__file__).parents[3])
_UNSHARE: Final = (
    f"import sys; sys.path.insert(0, {_KIT!r}); "
    "from kit.host.sandbox.namespaces import unshare_namespaces; unshare_namespaces()"
)


def _find_program() -> str | None:
    """Returns the program's absolute path; None if it is not installed. One in the current folder, which an empty entry of PATH
    would find, may be a student's."""
    found = shutil.which(PROGRAM)
    return found if found is not None and os.path.isabs(found) else None


@cache
def is_needed() -> bool:
    """Returns whether namespaces are refused to this process's children, and bubblewrap makes them. Tried once."""
    program = _find_program()
    if program is None or _succeeds([sys.executable, "-S", "-P", "-c", _UNSHARE]):
        return False
    return _succeeds([program, "--unshare-all", "--ro-bind", "/", "/", sys.executable, "-S", "-P", "-c", ""])


def _succeeds(command: list[str]) -> bool:
    try:
        return subprocess.run(command, capture_output=True, timeout=TRIAL_S, check=False).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return False


def wrap_command(command: list[str], tree: FileTree, scratch: str, room: int) -> list[str]:
    """Returns the command that runs ``command`` in namespaces of its own, with nothing to see but ``tree``.

    ``scratch`` becomes an empty folder in memory with room for ``room`` bytes, and the working folder.
    """
    program = _find_program()
    assert program is not None, "`is_needed` has found it"
    shown = FileTree((*tree.readable, *_interpreter_paths(command[0])), tree.writable, tree.hidden)
    own = (
        "--perms",
        "0700",
        "--size",
        str(room),
        "--tmpfs",
        scratch,
        "--remount-ro",
        "/",
        "--chdir",
        scratch,
    )
    return [program, "--unshare-all", "--die-with-parent", *_mount_arguments(shown), *own, "--", *command]


def _interpreter_paths(executable: str) -> Iterator[str]:
    """Yields what Python needs to start, besides its libraries: itself, and the file that makes it a virtual one."""
    yield executable
    yield str(Path(executable).parents[1] / "pyvenv.cfg")


def _mount_arguments(tree: FileTree) -> Iterator[str]:
    covered = []
    for mount in plan_mounts(tree):
        if mount.real is not None:
            kind = "--dev-bind" if mount.is_writable or mount.name.startswith("/dev/") else "--ro-bind"
            yield from (kind, mount.real, mount.name)
        elif os.path.isdir(mount.name):
            covered.append(mount.name)
            yield from ("--tmpfs", mount.name)
        elif os.path.exists(mount.name):
            yield from ("--ro-bind", os.devnull, mount.name)
    for folder in covered:
        yield from ("--remount-ro", folder)
