"""Limits of a student process, and what counts against that of its disk.

Where a reply or the start is waited for, processor time counts, so that a busy machine stops nobody; a longer limit by the wall
clock ends what neither computes nor answers. The time for which a program is ready to compute and gets no processor does not
count (Linux). The limit of all waiting together is of the wall clock.
"""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from dataclasses import dataclass
from typing import Final

KIB: Final = 1024
MIB: Final = 1024 * KIB
GIB: Final = 1024 * MIB


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one process. The defaults are for interactive use: generous, there to stop accidents."""

    start_s: float = 20.0
    """Processor time until the code is loaded and waits for the first time. Importing large packages happens here."""
    reply_s: float = 3.0
    """Processor time until each complete reply."""
    wall_factor: float = 10.0
    """How many times as long the start and a reply may take by the wall clock without computing."""
    total_s: float | None = None
    """Limit for all waiting for replies together; None: no limit."""
    cpu_s: int | None = None
    """CPU seconds of the child in all, counted by the kernel; None: no limit."""
    memory: int = 8 * GIB
    """Bytes of address space."""
    open_files: int = 256
    processes: int | None = None
    """Processes and threads beyond those that the user already has; None: no limit. Root is never limited."""
    file_size: int = 256 * MIB
    """Bytes of one written file."""
    scratch: int = 1 * GIB
    """Bytes of all files in its own folder together."""
    files: int = 20_000
    """Files and folders in its own folder."""
    output: int = 64 * KIB
    """Bytes of printed text that are kept until ``take_output``; more is counted and dropped."""
    frame: int = 4 * MIB
    """Bytes of one frame from the child."""
    messages: int | None = None
    """Messages, requests and responses that the child sends within one tick; None: no limit."""
    kept: int | None = None
    """Bytes of messages that are kept for the child in the kit's process: those of its publishers for subscriptions that
    come later, and requests that it has not answered; None: no limit."""

    @property
    def start_wall_s(self) -> float:
        """Limit of the start by the wall clock [s]."""
        return self._wall_limit(self.start_s)

    @property
    def reply_wall_s(self) -> float:
        """Limit of each reply by the wall clock [s]."""
        return self._wall_limit(self.reply_s)

    def _wall_limit(self, processor_s: float) -> float:
        wall_s = self.wall_factor * processor_s
        return wall_s if self.total_s is None else max(processor_s, min(wall_s, self.total_s))


INTERACTIVE_LIMITS: Final = Limits()
"""For interactive use and the terminal game: the student's own machine."""

GRADER_LIMITS: Final = Limits(
    start_s=15.0,
    reply_s=5.0,
    total_s=120.0,
    cpu_s=60,
    memory=1 * GIB,
    open_files=64,
    processes=16,
    file_size=8 * MIB,
    scratch=32 * MIB,
    files=1000,
    output=32 * KIB,
    frame=1 * MIB,
    messages=500,
    kept=64 * MIB,
)
"""For the grader: a long reply now and then is tolerated (a busy machine)."""


INTERVAL_S: Final = 0.1
"""The least time between two counts [s]."""
PAUSE_PER_COUNT: Final = 20
"""How many times longer than a count the pause after it is: counting takes a twentieth of one core at most."""
BLOCK: Final = 512
"""Bytes of the unit of ``st_blocks``."""


def exceeds_disk_limit(folder: str, process: int, max_bytes: int, max_files: int) -> bool:
    """Returns whether the folder, or the deleted files that the process keeps open, are larger than allowed.

    Folders and links count as files. What cannot be counted (a folder that its owner has locked, or too deep a one)
    exceeds the limit.
    """
    size, count, folders = _size_of_deleted_files(process), 0, [folder]
    while folders:
        try:
            with os.scandir(folders.pop()) as entries:
                for entry in entries:
                    with suppress(FileNotFoundError):  # deleted while we count
                        size += entry.stat(follow_symlinks=False).st_blocks * BLOCK
                        count += 1
                        if entry.is_dir(follow_symlinks=False):
                            folders.append(entry.path)
                    if size > max_bytes or count > max_files:
                        return True
        except (FileNotFoundError, NotADirectoryError):  # deleted or replaced while we count
            continue
        except OSError:
            return True
    return size > max_bytes


def _size_of_deleted_files(process: int) -> int:
    """Returns the bytes of files that have no name any more and live as long as the process keeps them open (Linux)."""
    size = 0
    with suppress(OSError), os.scandir(f"/proc/{process}/fd") as descriptors:
        for each in descriptors:
            with suppress(OSError):  # closed while we count
                status = os.stat(each.path)
                if stat.S_ISREG(status.st_mode) and status.st_nlink == 0:
                    size += status.st_blocks * BLOCK
    return size
