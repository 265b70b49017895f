"""The compiled kernels that all accounts of a machine share: where they lie, and whether they are to be trusted.

numba unpickles what it finds in a cache, which can run code. So a folder is read only where nobody can write in it but root or
the owner of the kit's own files, who decide what runs here anyway. Imports no numba: ``kit doctor`` looks at them too.
"""

from __future__ import annotations

import stat
import sys
from collections.abc import Iterator
from errno import EPERM
from pathlib import Path
from typing import Final

PACKAGE: Final = Path(__file__).parents[1]
SOURCES: Final = (PACKAGE / "kernels", PACKAGE / "sim")
"""Folders with functions that are compiled: arrays are computed with in the first, the second has one that C code calls."""
SUFFIXES: Final = (".nbi", ".nbc")
"""Files of numba's cache: the index of a kernel, and its machine code for arguments of certain types."""
OTHERS_WRITE: Final = stat.S_IWGRP | stat.S_IWOTH


def shared_folders() -> tuple[Path, ...]:
    """Returns the folders of the installation that hold compiled kernels, or are to hold them."""
    return tuple(folder / "__pycache__" for folder in SOURCES)


def kept_files(folder: Path) -> Iterator[Path]:
    """Yields the files of compiled kernels in a folder. Raises OSError if it cannot be read."""
    return (entry for entry in sorted(folder.iterdir()) if entry.suffix in SUFFIXES)


def unshared_reason(folder: Path) -> str:
    """Says why an account that has not made it does not read what a folder holds; empty if it does."""
    if sys.platform == "win32":
        return "Windows has no owners and rights of this kind"
    try:
        owners = {0, PACKAGE.stat().st_uid}
        for path in (folder, *kept_files(folder)):
            found = path.lstat()
            if stat.S_ISLNK(found.st_mode):
                return f"{path} is a link"
            if found.st_uid not in owners:
                return (
                    f"{path} belongs to user {found.st_uid}, and neither to root nor to the owner of the kit"
                )
            if found.st_mode & OTHERS_WRITE:
                return f"{path} may be written by others than its owner"
    except OSError as error:
        return f"{folder} cannot be read: {error.strerror}"
    return ""


def make_ready(folder: Path) -> None:
    """Makes a folder in which only this account writes and all may read. Kernels that lie there though others may have written
    them are removed. Raises OSError, also where others may replace the folder itself."""
    if folder.parent.stat().st_mode & OTHERS_WRITE:
        raise PermissionError(EPERM, "others than its owner may write there: chmod go-w", str(folder.parent))
    folder.mkdir(exist_ok=True)
    if unshared_reason(folder):
        for path in kept_files(folder):
            path.unlink()
    folder.chmod(0o755)


def let_all_read(folder: Path) -> int:
    """Lets every account read a folder's kernels, and returns their bytes. Raises OSError."""
    size = 0
    for path in kept_files(folder):
        path.chmod(0o644)
        size += path.stat().st_size
    return size
