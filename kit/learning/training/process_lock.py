"""The lock by which a process keeps others from doing the same work; the system lets go when it ends, however it does."""

from __future__ import annotations

import fcntl
import time
from collections.abc import Iterator
from contextlib import contextmanager
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


def _lock(lock: BinaryIO) -> bool:
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
