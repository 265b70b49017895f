"""The lock by which a process keeps others from doing the same work; the system lets go when it ends, however it does."""

from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, Final

LOCK_WAIT_S: Final = 0.2
"""Seconds to wait for a lock, which a process that asks ``is_locked`` holds for a moment."""


class LockedError(Exception):
    """Another process holds the lock."""


@contextmanager
def process_lock(file: Path) -> Iterator[BinaryIO]:
    """Holds the lock, and gives its file, open for reading and appending. Raises LockedError if another process holds it, and
    OSError."""
    with file.open("a+b") as lock:
        until = time.monotonic() + LOCK_WAIT_S
        while not _lock(lock):
            if time.monotonic() >= until:
                raise LockedError(file)
            time.sleep(LOCK_WAIT_S / 20)
        yield lock


def is_locked(file: Path) -> bool:
    """Whether a process holds the lock."""
    try:
        with file.open("rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
            return False
    except FileNotFoundError:
        return False
    except OSError:  # it is locked
        return True


def holds_open(process: int, file: Path) -> bool:
    """Whether a process has the file open; True where the system does not tell. Raises OSError where there is no such process."""
    if not Path("/proc/self/fd").exists():
        return True
    wanted = file.stat()
    for opened in Path(f"/proc/{process}/fd").iterdir():
        with suppress(FileNotFoundError):  # it has closed it meanwhile
            if os.path.samestat(opened.stat(), wanted):
                return True
    return False


def _lock(lock: BinaryIO) -> bool:
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
