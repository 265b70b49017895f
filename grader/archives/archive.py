"""Reads a submitted archive safely: every byte that is unpacked counts, headers too, as it comes.

Nothing is ever extracted to disk: an archive becomes names and bytes.
"""

from __future__ import annotations

import lzma
import tarfile
import zipfile
import zlib
from typing import BinaryIO, Final

from grader.archives.streams import COMPRESSION_MAGIC
from grader.archives.tar_archive import read_tar
from grader.archives.zip_archive import ZIP_MAGIC, read_zip
from grader.file_formats import PACK_ADVICE, advice, file_kind
from grader.shown_names import shown_name
from grader.submitted_files import SubmissionRefused, SubmittedFiles

MAX_PACKED_BYTES: Final = 64 * 1024 * 1024
"""Bytes of an archive as it is handed in."""
DAMAGED_MESSAGE: Final = (
    f"The archive is damaged, or its format is not supported. Pack it again, or {PACK_ADVICE}."
)

_ARCHIVE_ENDINGS: Final = (
    ".zip", ".tar", ".tar.gz", ".tgz", ".tar.xz", ".txz", ".tar.bz2", ".tbz2", ".tbz",
)  # fmt: skip


def archive_stem(name: str) -> str | None:
    """Returns an archive's name without its ending, dots kept: ``j.doe_hw1``; None if it is no archive's name."""
    endings = [ending for ending in _ARCHIVE_ENDINGS if name.lower().endswith(ending)]
    return name[: -max(map(len, endings))] if endings else None


def unpack_archive(file: BinaryIO, name: str, files: SubmittedFiles) -> None:
    """Reads the needed files of an archive into ``files``. Raises SubmissionRefused."""
    start = file.read(tarfile.BLOCKSIZE)
    if not start:
        raise SubmissionRefused(
            f"{shown_name(name)[1:-1]} is empty: pack your work again, and hand it in again."
        )
    is_zip = name.lower().endswith(".zip") or start.startswith(ZIP_MAGIC)
    kind = None if start.startswith((ZIP_MAGIC, *COMPRESSION_MAGIC)) else file_kind(start)
    if kind is not None:
        raise SubmissionRefused(
            f"{shown_name(name)[1:-1]} is {kind}, whatever its name says: {advice(kind)}."
        )
    try:
        if is_zip:
            read_zip(file, files)
        else:
            read_tar(file, files)
    except (
        zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, EOFError, ValueError, OSError,
        RuntimeError,  # NotImplementedError is one: zipfile's for a method that it cannot unpack
    ) as error:  # fmt: skip
        if isinstance(error, RecursionError):  # a RuntimeError, but no statement about the archive
            raise
        raise SubmissionRefused(DAMAGED_MESSAGE) from None
