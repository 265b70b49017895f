"""The grader hides from the programs it runs: no other process of the same user may read its memory or files."""

from __future__ import annotations

import ctypes
import sys
from contextlib import suppress
from typing import Final

_PR_SET_DUMPABLE: Final = 4


def hide_process() -> None:
    """From here on, a process of the same user cannot look into this one through /proc. Linux; else nothing.

    Level 0 has no more than this; root sees through it. From level 1 on a program does not see /proc at all.
    """
    if sys.platform != "linux":
        return
    with suppress(OSError, AttributeError):  # a C library without prctl: then level 1 is out of reach as well
        ctypes.CDLL(None).prctl(_PR_SET_DUMPABLE, 0, 0, 0, 0)
