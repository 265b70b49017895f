"""What ``prctl`` does for a process: orphans become its children, it dies with its parent, others may not read it."""

from __future__ import annotations

import ctypes
import sys

PR_SET_PDEATHSIG, PR_SET_DUMPABLE, PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 1, 4, 36, 38
PR_SET_THP_DISABLE = 41


def prctl(option: int, value: int) -> None:
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0)


def adopt_orphans() -> None:
    """Makes this process the parent of all orphans below it (Linux)."""
    prctl(PR_SET_CHILD_SUBREAPER, 1)


def shield_this_process() -> None:
    """Forbids other processes of this user to read this one's memory, files and environment (Linux).

    For processes that hold secrets, such as the grader's. Processes that it starts are not protected.
    """
    prctl(PR_SET_DUMPABLE, 0)
