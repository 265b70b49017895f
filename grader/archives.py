"""Reads submitted archives safely: limits the number, size, depth and names of their files.

Nothing is ever extracted to disk: an archive becomes names and bytes.
"""

from __future__ import annotations

import io
import lzma
import re
import tarfile
import zipfile
import zlib
from collections.abc import Iterator
from typing import IO, Final

MAX_FILES: Final = 200
MAX_BYTES: Final = 8 * 1024 * 1024
"""Bytes of all files together, unpacked."""
MAX_DEPTH: Final = 6
"""Levels of nested folders."""
MAX_COMPRESSION_RATIO: Final = 200
"""Unpacked to packed bytes: text packs to a tenth, a bomb to a thousandth."""

_NAME_PATTERN: Final = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_. +\-()]{0,99}")
_ARCHIVE_ENDINGS: Final = (".zip", ".tar", ".tar.gz", ".tgz")
_IGNORED_PARTS: Final = ("__MACOSX", "__pycache__", ".DS_Store", ".git")


class SubmissionRefused(Exception):
    """The submission cannot be graded; the message tells the student why."""


def is_archive(name: str) -> bool:
    return name.lower().endswith(_ARCHIVE_ENDINGS)


def unpack_archive(content: bytes, name: str) -> dict[str, bytes]:
    """Returns the plain files of an archive: content by relative name. Raises SubmissionRefused."""
    try:
        pairs = _zip_files(content) if name.lower().endswith(".zip") else _tar_files(content)
        files: dict[str, bytes] = {}
        lower: set[str] = set()
        for path, data in pairs:
            if any(part in _IGNORED_PARTS for part in path.split("/")):
                continue
            check_name(path)
            if path.lower() in lower:
                raise SubmissionRefused(f"The archive holds {path!r} twice.")
            lower.add(path.lower())
            files[path] = data
    except (
        zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, EOFError, ValueError, OSError,
        NotImplementedError, RuntimeError,
    ):  # fmt: skip
        raise SubmissionRefused(
            "The archive is damaged, locked or of a kind that is not read here."
        ) from None
    return files


def check_name(path: str) -> None:
    """Raises SubmissionRefused for a name that leads out of the folder or could be mistaken for another."""
    parts = path.split("/")
    if len(parts) > MAX_DEPTH:
        raise SubmissionRefused(f"The folders are more than {MAX_DEPTH} deep.")
    for part in parts:
        if not _NAME_PATTERN.fullmatch(part) or part.endswith((".", " ")):
            shown = ascii(path[:80])
            raise SubmissionRefused(f"{shown} is no name for a file here: letters, digits, and _ . - + ( ).")


class _UnpackLimit:
    def __init__(self, packed: int) -> None:
        self._bytes = min(MAX_BYTES, max(65536, packed * MAX_COMPRESSION_RATIO))
        self._files = MAX_FILES

    def read(self, stream: IO[bytes]) -> bytes:
        """Reads one file, and counts its true bytes: the size that the archive declares is not trusted."""
        data = stream.read(self._bytes + 1)
        self._bytes -= len(data)
        if self._bytes < 0:
            raise SubmissionRefused(f"The archive unpacks to more than {MAX_BYTES >> 20} MiB, or is a bomb.")
        return data

    def count_entry(self) -> None:
        self._files -= 1
        if self._files < 0:
            raise SubmissionRefused(f"The archive holds more than {MAX_FILES} entries.")


def _zip_files(content: bytes) -> Iterator[tuple[str, bytes]]:
    limit = _UnpackLimit(len(content))
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        for entry in archive.infolist():
            limit.count_entry()
            if entry.is_dir():
                continue
            mode = entry.external_attr >> 16
            if mode & 0o170000 not in (0, 0o100000):
                raise SubmissionRefused(f"{entry.filename[:80]!a} is a link or a device; hand in files only.")
            with archive.open(entry) as stream:
                yield entry.filename, limit.read(stream)


def _tar_files(content: bytes) -> Iterator[tuple[str, bytes]]:
    limit = _UnpackLimit(len(content))
    with tarfile.open(fileobj=io.BytesIO(content), mode="r|*") as archive:
        for entry in archive:
            limit.count_entry()
            if entry.isdir():
                continue
            if not entry.isreg():
                raise SubmissionRefused(f"{entry.name[:80]!a} is a link or a device; hand in files only.")
            stream = archive.extractfile(entry)
            assert stream is not None  # a regular file
            yield entry.name.removeprefix("./"), limit.read(stream)
