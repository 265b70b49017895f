"""Opens files that somebody else may have made: plain ones alone, and never more of one than is allowed."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO


def open_plain_file(file: Path | str, *, follows_links: bool = True, folder: int | None = None) -> BinaryIO:
    """Opens a plain file for reading. A named pipe or a device never holds this process: it is an OSError.

    ``folder``: descriptor of the folder that ``file`` is a name in. What is looked at is what is read, whoever exchanges
    names meanwhile.
    """
    flags = os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | (0 if follows_links else os.O_NOFOLLOW)
    handle = os.open(file, flags, dir_fd=folder)
    if stat.S_ISDIR(mode := os.fstat(handle).st_mode):
        os.close(handle)
        raise IsADirectoryError(errno.EISDIR, "it is a folder", str(file))
    if not stat.S_ISREG(mode):
        os.close(handle)
        raise OSError(errno.EINVAL, "it is not a plain file", str(file))
    return os.fdopen(handle, "rb")


def read_plain_file(file: Path | str, limit: int) -> bytes:
    """Returns the content of a plain file of at most ``limit`` bytes. Raises OSError for any other."""
    with open_plain_file(file) as opened:
        # Counted as it comes: a file may grow while it is read.
        content = opened.read(limit + 1) if os.fstat(opened.fileno()).st_size <= limit else None
    if content is None or len(content) > limit:
        raise OSError(errno.EFBIG, f"it is larger than {limit / 1e6:.3g} MB", str(file))
    return content


def is_file_there(file: Path) -> bool:
    """Returns whether there is a file of this name; False for what cannot be a name, where ``Path.is_file`` raises."""
    try:
        return file.is_file()
    except (OSError, ValueError):
        return False
