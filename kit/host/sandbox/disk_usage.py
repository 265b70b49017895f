"""Counts the bytes and files that a running program keeps in its own folder, where no file system limits them.

Levels 2 and above give a program a file system of its own with limits. Below, the process above the student's looks
now and then, so a program may exceed its limit for a moment; it is ended then.
"""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from typing import Final

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
