"""Ends a process and everything that it has started, and removes the folder of a run.

Killing a process group is not enough: a program that forks twice and starts a session of its own is in no
known group. So each student's code runs under a small process of the kit's that adopts its orphans
(``PR_SET_CHILD_SUBREAPER``), and everything below that process is the student's.
"""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress

KILL_TIMEOUT_S = 2.0
"""How long to go on killing what keeps forking [s]."""

_REMOVE, _UNLOCK = ("rm", "-rf"), ("chmod", "-R", "u+rwx")


def descendants(root: int) -> list[int]:
    """Returns the living processes below ``root``, nearest first; none on other systems than Linux."""
    children: dict[int, list[int]] = {}
    for entry in os.listdir("/proc") if os.path.isdir("/proc/self") else ():
        if entry.isdigit():
            with suppress(OSError):  # ended while we looked
                with open(f"/proc/{entry}/stat", "rb") as file:
                    stat = file.read()
                # "pid (name) state ppid ...", and the name may hold spaces and brackets. A dead process (Z, X)
                # that nobody has waited for has no children any more.
                state, parent = stat.rpartition(b")")[2].split()[:2]
                if state not in (b"Z", b"X"):
                    children.setdefault(int(parent), []).append(int(entry))
    found = [root]
    for process in found:
        found += children.get(process, ())
    return found[1:]


def end_descendants(root: int) -> bool:
    """Kills everything below ``root`` until nothing is left alive; returns False if that took too long."""
    deadline = time.monotonic() + KILL_TIMEOUT_S
    while living := descendants(root):
        for process in living:
            with suppress(ProcessLookupError, PermissionError):
                os.kill(process, signal.SIGKILL)
        if time.monotonic() > deadline:
            return False
        time.sleep(0.001)
    return True


def remove_folder(folder: str) -> None:
    """Removes a run's folder and all in it, however deep, and even if its owner has locked parts of it."""
    with suppress(OSError):
        for name in os.listdir(folder):
            os.rmdir(f"{folder}/{name}")  # mostly they are empty
        os.rmdir(folder)
    for command in (_REMOVE, _UNLOCK, _REMOVE):
        if not os.path.lexists(folder):
            return
        arguments = (*command, "--", folder)
        os.waitpid(os.posix_spawnp(arguments[0], arguments, {"PATH": "/usr/bin:/bin"}), 0)
