"""Reads a zip archive's needed files."""

from __future__ import annotations

import zipfile
from typing import BinaryIO, Final

from grader.shown_names import shown_name
from grader.submitted_files import VIRTUAL_ENVIRONMENT_FILE, SubmissionRefused, SubmittedFiles

MAX_DIRECTORY_BYTES: Final = 4 * 1024 * 1024
"""Bytes of the directory of a zip archive."""


ZIP_MAGIC: Final = b"PK\x03\x04"


class _BoundedReads:
    """A file in which one read cannot take more than the directory of an archive may."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def read(self, size: int = -1, /) -> bytes:
        if size > MAX_DIRECTORY_BYTES:
            raise SubmissionRefused("The archive names far too many files: hand in only your program.")
        return self._file.read(MAX_DIRECTORY_BYTES if size < 0 else size)

    def seek(self, offset: int, whence: int = 0, /) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()

    def seekable(self) -> bool:
        return True


def read_zip(file: BinaryIO, files: SubmittedFiles) -> None:
    with zipfile.ZipFile(_BoundedReads(file)) as archive:
        for entry in archive.infolist():
            folder, _, name = _path_in_zip(entry).rpartition("/")
            if name == VIRTUAL_ENVIRONMENT_FILE and folder:
                files.ignore(folder)
        for entry in archive.infolist():
            path = _path_in_zip(entry)
            if not path or path.endswith("/"):
                files.count_entry()
                continue
            if not files.needs(path):
                continue
            if entry.external_attr >> 16 & 0o170000 not in (0, 0o100000):
                raise SubmissionRefused(f"{shown_name(path)} is a link or a device; hand in files only.")
            if entry.flag_bits & 1:
                raise SubmissionRefused("The archive is locked with a password: pack it without one.")
            if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise SubmissionRefused(
                    "The archive uses an unsupported compression method: pack it as a plain .zip (“deflate”)."
                )
            with archive.open(entry) as stream:
                files.add(path, stream.read)


def _path_in_zip(entry: zipfile.ZipInfo) -> str:
    """Returns an entry's path; some programs for Windows write backslashes, and some others begin with ``./``."""
    return entry.filename.replace("\\", "/").removeprefix("./")
