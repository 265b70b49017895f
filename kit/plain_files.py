"""Opens files that somebody else may have made: plain ones alone, and never more of one than is allowed; finds the file that
a wrong name means."""

from __future__ import annotations

import errno
import os
import stat
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, Final
from urllib.parse import unquote

from kit.plain_text import nearest_name

MAX_PARTS: Final = 100_000
"""Files and folders in a folder that the kit works in."""


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


def foreign_part(folder: Path) -> str:
    """What keeps a folder that somebody else has made from being read and written by the names in it: a link, which may lead to
    a file of this user's, or a pipe or device, which may hold a reader for ever. Empty if nothing does."""
    folders, count = [folder], 0
    while folders:
        found = folders.pop()
        try:
            with os.scandir(found) as entries:
                for entry in entries:
                    count += 1
                    if entry.is_dir(follow_symlinks=False):
                        folders.append(Path(entry.path))
                    elif not entry.is_file(follow_symlinks=False):
                        name = Path(entry.path).relative_to(folder)
                        return f"{name} is {'a link' if entry.is_symlink() else 'no plain file'}"
                    if count > MAX_PARTS:
                        return f"it has more than {MAX_PARTS:,} files"
        except FileNotFoundError:  # removed meanwhile
            continue
        except OSError as error:
            return f"{found.name} cannot be read ({error.strerror})"
    return ""


def is_file_there(file: Path) -> bool:
    """Returns whether there is a file of this name; False for what cannot be a name, where ``Path.is_file`` raises."""
    try:
        return file.is_file()
    except (OSError, ValueError):
        return False


def nearest_file(file: Path, *, is_folder: bool = False) -> str:
    """The path of a file that is there for one that is not: as ``near_file`` finds it, or the one in its folder whose name is
    nearest. Empty if there is none."""
    if near := near_file(str(file), is_folder=is_folder):
        return near
    with suppress(OSError):
        names = [each.name for each in file.parent.iterdir() if each.is_dir() == is_folder]
        if (nearest := nearest_name(file.name, names)) is not None:
            return str(file.with_name(nearest))
    return ""


def near_file(name: str, folder: Path | None = None, *, is_folder: bool = False) -> str:
    """The name of a file that is there, relative to ``folder``, for one that is not: written with the separators of
    Windows, in the other case, or as the address or the path that it has on another machine. Empty if there is none.

    ``folder``: by default the one in which the program runs. ``is_folder``: a folder is looked for, not a file.
    """
    folder = folder or Path.cwd()
    words = unquote(name.removeprefix("file://")).replace("\\", "/").split("/")
    words = [word for word in words if word not in ("", ".", "~") and not word.endswith(":")]
    for first in range(len(words)):  # all of the path, then what is left without its first folders
        found = folder
        for word in words[first:]:
            if word == "..":
                found = found.parent
                continue
            with suppress(OSError):
                names = [path.name for path in found.iterdir()]
                match = word if word in names else next((n for n in names if n.lower() == word.lower()), None)
                if match is not None:
                    found = found / match
                    continue
            break
        else:
            if (found.is_dir() if is_folder else found.is_file()) and found.is_relative_to(folder):
                return str(found.relative_to(folder))
    return ""
