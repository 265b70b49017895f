"""A process's user, rights and limits, taken away for good."""

from __future__ import annotations

import ctypes
import os
import resource
import sys
from contextlib import suppress
from typing import Final

from kit.host.sandbox import libc
from kit.host.sandbox.limits import KIB
from kit.host.sandbox.sandbox_config import ConfinementError, Level, SandboxConfig

MAX_PENDING_SIGNALS = 128
"""Signals and timers that wait, of all programs of its user together."""
MAX_LOCKED_BYTES = 64 * KIB
"""Bytes of memory that cannot be written to the disk."""
NO_CORE: Final = 1
"""Bytes of a core file: less than any has, and the one limit at which Linux starts no program to which cores are piped. With
0 it does, as root, and such a program keeps the memory of a process that has crashed."""
FIRST_USER, USERS = 1_500_000_000, 100_000_000
"""User ids for runs, above those that systems give to people, services and containers."""


def set_limits(config: SandboxConfig) -> None:
    limits = config.limits
    wanted = {
        resource.RLIMIT_AS: limits.memory,
        resource.RLIMIT_NOFILE: limits.open_files,
        resource.RLIMIT_FSIZE: limits.file_size,
        resource.RLIMIT_CORE: NO_CORE,
    }
    if limits.processes is not None:
        running = 0 if config.level >= Level.ANOTHER_USER else _threads_of(os.getuid())
        wanted[resource.RLIMIT_NPROC] = running + limits.processes
    if config.level >= Level.FILTERED and sys.platform == "linux":
        wanted[resource.RLIMIT_MEMLOCK] = MAX_LOCKED_BYTES
        wanted[resource.RLIMIT_MSGQUEUE] = 0
        wanted[resource.RLIMIT_SIGPENDING] = MAX_PENDING_SIGNALS
    for kind, value in wanted.items():
        _set_limit(kind, value, value)
    if limits.cpu_s is not None:
        # The soft limit ends the program with a signal of its own, which tells us why; the hard one kills.
        _set_limit(resource.RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1)


def _set_limit(kind: int, soft: int, hard: int) -> None:
    allowed = resource.getrlimit(kind)[1]
    if allowed != resource.RLIM_INFINITY:
        soft, hard = min(soft, allowed), min(hard, allowed)
    with suppress(ValueError, OSError):  # a system that knows the limit but does not set it (macOS, memory)
        resource.setrlimit(kind, (soft, hard))


def _threads_of(user: int) -> int:
    """Returns how many threads a user has: the kernel counts them against the limit of processes."""
    count = 0
    for process in filter(str.isdigit, os.listdir("/proc") if os.path.isdir("/proc/self") else ()):
        with suppress(OSError):
            if os.stat(f"/proc/{process}").st_uid == user:
                count += len(os.listdir(f"/proc/{process}/task"))
    return count


def switch_user(user: int, scratch: str) -> None:
    """Makes this process belong to a user of its own."""
    try:
        os.chown(scratch, user, user)
        os.setgroups([])
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
    except OSError as problem:
        raise ConfinementError(
            f"a user for each run is refused ({problem.strerror}): this root is only a container's."
        ) from None


class _Header(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint32), ("process", ctypes.c_int))


def drop_capabilities() -> None:
    """Gives up root's rights."""
    header, nothing = _Header(0x20080522, 0), (ctypes.c_uint32 * 6)()
    if libc().capset(ctypes.byref(header), ctypes.byref(nothing)):
        raise OSError(ctypes.get_errno(), f"capset: {os.strerror(ctypes.get_errno())}")
