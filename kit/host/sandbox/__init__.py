"""Confinement of student processes: limits, Landlock, seccomp, namespaces, and what this machine supports."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import ctypes


@cache  # loading it costs as much as a mount, and there are hundreds
def libc() -> ctypes.CDLL:
    """The C library, for the system calls that Python has no function for."""
    import ctypes  # not for those who read the limits

    return ctypes.CDLL(None, use_errno=True)
