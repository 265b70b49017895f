"""Reads a tar archive's needed files, block by block."""

from __future__ import annotations

import tarfile
from typing import BinaryIO, Final

from grader.archives.streams import BOMB_MESSAGE, CountingStream
from grader.shown_names import shown_name
from grader.submitted_files import SubmissionRefused, SubmittedFiles

MAX_HEADER_BYTES: Final = 64 * 1024
"""Bytes of one extended header of a tar archive."""
MAX_HEADER_RECORDS: Final = 100
"""Records of one extended header; programs that pack write a dozen."""
MAX_LENGTH_DIGITS: Final = 9
"""Digits of a record's length."""


_EXTENDED_HEADERS: Final = (
    tarfile.GNUTYPE_LONGNAME,
    tarfile.GNUTYPE_LONGLINK,
    tarfile.XHDTYPE,
    tarfile.XGLTYPE,
    tarfile.SOLARIS_XHDTYPE,
)


def read_tar(file: BinaryIO, files: SubmittedFiles) -> None:
    """Reads a tar archive block by block. The standard library's reader reads a header of any size at once."""
    stream = CountingStream(file)
    path: str | None = None
    size: int | None = None
    is_first = True
    while True:
        block = stream.read(tarfile.BLOCKSIZE)
        if not is_first and (not block or not any(block)):
            return
        is_first = False
        header = tarfile.TarInfo.frombuf(block, "utf-8", "surrogateescape")
        if header.type in _EXTENDED_HEADERS:
            files.count_entry()
            if header.size > MAX_HEADER_BYTES:
                raise SubmissionRefused(BOMB_MESSAGE)
            content = stream.read(_round_up_to_block(header.size))[: header.size]
            if header.type == tarfile.GNUTYPE_LONGNAME:
                path = content.rstrip(b"\0").decode("utf-8", "surrogateescape")
            elif header.type in (tarfile.XHDTYPE, tarfile.SOLARIS_XHDTYPE):
                path, size = _pax_values(content, path)
            continue
        length = header.size if size is None else size
        _read_member(stream, header, (path or header.name).removeprefix("./"), length, files)
        path = size = None


def _read_member(
    stream: CountingStream, header: tarfile.TarInfo, path: str, length: int, files: SubmittedFiles
) -> None:
    if length < 0:
        raise ValueError("a negative size")
    if header.isdir() or path in ("", "."):
        files.count_entry()
        return
    has_content = header.isreg()
    if not files.needs(path):
        stream.skip(_round_up_to_block(length) if has_content else 0)
        return
    if not has_content or header.type == tarfile.GNUTYPE_SPARSE:
        raise SubmissionRefused(f"{shown_name(path)} is a link or a device; hand in files only.")
    left = length

    def read(count: int) -> bytes:
        nonlocal left
        content = stream.read(min(count, left))
        if left and not content:
            raise EOFError
        left -= len(content)
        return content

    files.add(path, read)
    stream.skip(_round_up_to_block(length) - length)


def _round_up_to_block(size: int) -> int:
    """Returns a size rounded up to whole blocks."""
    return -(-size // tarfile.BLOCKSIZE) * tarfile.BLOCKSIZE


def _pax_values(content: bytes, path: str | None) -> tuple[str | None, int | None]:
    """Returns the path and the size that an extended header gives; ``path`` and None where it gives none."""
    size = None
    content = content.rstrip(b"\0")
    begin = 0  # records are read where they lie: what follows each would else be copied for it
    for _ in range(MAX_HEADER_RECORDS + 1):
        if begin >= len(content):
            return path, size
        blank = content.find(b" ", begin, begin + MAX_LENGTH_DIGITS + 1)
        length = int(content[begin:blank]) if blank > begin else 0
        if not 0 < blank - begin < length <= len(content) - begin:
            raise ValueError("an extended header of a wrong length")
        keyword, _, value = content[blank + 1 : begin + length - 1].partition(b"=")
        if keyword == b"path":
            path = value.decode("utf-8", "surrogateescape")
        elif keyword == b"size":
            size = int(value)
        elif keyword.startswith(b"GNU.sparse"):
            raise ValueError("a sparse file")
        begin += length
    raise SubmissionRefused(BOMB_MESSAGE)
