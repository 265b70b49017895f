"""Opens the files that a world names. A world may be untrusted, so nothing outside its folder
is opened, nothing that is not a plain file, and nothing without a limit on its size.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

from kit.plain_text import is_printable, quoted

WIDER_ROOT = ": use --root to allow a wider folder, or put a package.xml in it"
"""Advice at the end of the message about a file outside the allowed folder."""


class UnusableFile(Exception):
    """A file that cannot be used; the message says why, without naming the file."""


@dataclass(frozen=True, slots=True)
class AllowedRoot:
    """A folder that paths may not leave: not by ``..``, absolute paths or symbolic links."""

    display_path: Path
    """The folder as the user calls it: how its files are named in messages and records."""
    real_path: Path
    """The same, free of symbolic links."""

    @classmethod
    def of_folder(cls, root: Path) -> AllowedRoot:
        return cls(root, _resolve_links(root))

    @classmethod
    def containing(cls, file: Path) -> AllowedRoot:
        """The folder in which the file lies (really lies, if it is a symbolic link)."""
        return cls.of_folder((_resolve_links(file) if file.is_symlink() else file).parent)

    def resolve(self, text: str, folder: Path) -> Path:
        """Returns the file that ``text`` in a file of ``folder`` refers to. Raises Unusable."""
        if not text or not is_printable(text):
            raise UnusableFile(f"{quoted(text)} is not a file name")
        return self._checked(folder / text, text)

    def path_inside(self, path: Path) -> Path:
        """Returns the path of the same file below this folder. Raises Unusable if it lies elsewhere."""
        return self._checked(path, str(path))

    def _checked(self, path: Path, given: str) -> Path:
        real = _resolve_links(path)
        if not real.is_relative_to(self.real_path):
            folder = quoted(str(self.display_path), 200)
            raise UnusableFile(f"{quoted(given)} is outside the folder {folder}{WIDER_ROOT}")
        return self.display_path / real.relative_to(self.real_path)


_READ_FILES: ContextVar[set[Path] | None] = ContextVar("_READ_FILES", default=None)


@contextmanager
def collected_reads() -> Iterator[set[Path]]:
    """Collects the files that are read inside it by ``read_bytes``: all that a world consists of, if it is loaded here."""
    files: set[Path] = set()
    token = _READ_FILES.set(files)
    try:
        yield files
    finally:
        _READ_FILES.reset(token)


def read_bytes(path: Path, limit: int) -> bytes:
    """The content of a regular file of at most ``limit`` bytes. Raises Unusable."""
    if (collected := _READ_FILES.get()) is not None:
        collected.add(path)
    try:
        with open(path, "rb", opener=_open_nonblocking) as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise UnusableFile("it is not a regular file")
            content = file.read(limit + 1) if status.st_size <= limit else None
    except (OSError, ValueError) as error:
        raise UnusableFile(_error_text(error)) from error
    if content is None or len(content) > limit:
        raise UnusableFile(f"it is larger than {limit // 1_000_000} MB")
    return content


def _open_nonblocking(path: str, flags: int) -> int:
    """Opens a named pipe at once too, where ``open`` would wait for a writer."""
    return os.open(path, flags | os.O_NONBLOCK | os.O_CLOEXEC)


def _resolve_links(path: Path) -> Path:
    try:
        return path.resolve()
    except (OSError, RuntimeError, ValueError) as error:  # a loop of links; too long; a NUL in the name
        raise UnusableFile(f"{quoted(str(path))} cannot be a file: {_error_text(error)}") from error


def _error_text(error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    if isinstance(error, IsADirectoryError):
        return "it is a folder"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror.lower()
    return str(error).lower()
