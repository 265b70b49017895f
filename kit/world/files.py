"""Opening the files that a world names. A world may come from a stranger, so nothing outside its folder
is opened, nothing that is not a plain file, and nothing without a limit on its size.
"""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass
from pathlib import Path

from kit.world.problems import displayable, quoted


class Unusable(Exception):
    """A file that cannot be used; the message says why, without naming the file's place."""


@dataclass(frozen=True, slots=True)
class Enclosure:
    """A folder that nothing read through it may leave, not by ``..``, nor absolutely, nor by a symbolic link."""

    shown: Path
    """The folder as the user calls it: how its files are named in messages and records."""
    real: Path
    """The same, free of symbolic links."""

    @classmethod
    def of(cls, root: Path) -> Enclosure:
        return cls(root, _resolved(root))

    @classmethod
    def around(cls, file: Path) -> Enclosure:
        """The folder in which the file lies (really lies, if it is a symbolic link)."""
        return cls.of((_resolved(file) if file.is_symlink() else file).parent)

    def locate(self, text: str, folder: Path) -> Path:
        """The file that ``text`` means when a file in ``folder`` names it. Raises Unusable."""
        if not text or not displayable(text):
            raise Unusable(f"{quoted(text)} is not the name of a file")
        return self._inside(folder / text, text)

    def admit(self, path: Path) -> Path:
        """The same file by its name below this folder. Raises Unusable if it lies elsewhere."""
        return self._inside(path, str(path))

    def _inside(self, path: Path, said: str) -> Path:
        real = _resolved(path)
        if not real.is_relative_to(self.real):
            folder = quoted(str(self.shown), 200)
            raise Unusable(f"{quoted(said)} is outside the folder {folder}: allow a wider one as root")
        return self.shown / real.relative_to(self.real)


def read_bytes(path: Path, limit: int) -> bytes:
    """The content of a regular file of at most ``limit`` bytes. Raises Unusable."""
    try:
        with open(path, "rb", opener=_without_waiting) as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise Unusable("it is not a regular file")
            content = file.read(limit + 1) if status.st_size <= limit else None
    except (OSError, ValueError) as error:
        raise Unusable(_reason(error)) from error
    if content is None or len(content) > limit:
        raise Unusable(f"it is larger than {limit // 1_000_000} MB")
    return content


def _without_waiting(path: str, flags: int) -> int:
    """Opens a named pipe at once too, where ``open`` would wait until somebody writes to it."""
    return os.open(path, flags | os.O_NONBLOCK | os.O_CLOEXEC)


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, RuntimeError, ValueError) as error:  # a loop of links; too long; a NUL in the name
        raise Unusable(f"{quoted(str(path))} cannot be a file: {_reason(error)}") from error


def _reason(error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    if isinstance(error, IsADirectoryError):
        return "it is a folder"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror.lower()
    return str(error).lower()
