"""Reads submitted archives safely: every byte that is unpacked counts, headers too, as it comes.

Nothing is ever extracted to disk: an archive becomes names and bytes.
"""

from __future__ import annotations

import bz2
import lzma
import tarfile
import zipfile
import zlib
from collections.abc import Iterator
from typing import BinaryIO, Final, Protocol

from grader.file_formats import PACK_ADVICE, advice, file_kind
from grader.shown_names import shown_name
from grader.submitted_files import READ_SIZE, VIRTUAL_ENVIRONMENT_FILE, SubmissionRefused, SubmittedFiles

MAX_PACKED_BYTES: Final = 64 * 1024 * 1024
"""Bytes of an archive as it is handed in."""
MAX_UNPACKED_BYTES: Final = 128 * 1024 * 1024
"""Bytes out of a compressed stream: headers, needed files, and those that are passed over."""
MAX_COMPRESSION_RATIO: Final = 200
"""Unpacked to packed bytes: text packs to a tenth, a bomb to a thousandth."""
MAX_HEADER_BYTES: Final = 64 * 1024
"""Bytes of one extended header of a tar archive."""
MAX_HEADER_RECORDS: Final = 100
"""Records of one extended header; programs that pack write a dozen."""
MAX_LENGTH_DIGITS: Final = 9
"""Digits of a record's length."""
MAX_DIRECTORY_BYTES: Final = 4 * 1024 * 1024
"""Bytes of the directory of a zip archive."""
MAX_DICTIONARY_BYTES: Final = 96 * 1024 * 1024
"""Memory for unpacking xz, whose highest preset needs 65 MiB."""

BOMB_MESSAGE: Final = (
    "It unpacks to far more than a program needs, or is a decompression bomb; hand in only your program."
)
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
    is_zip = name.lower().endswith(".zip") or start.startswith(_ZIP_MAGIC)
    kind = None if start.startswith((_ZIP_MAGIC, *_MAGIC)) else file_kind(start)
    if kind is not None:
        raise SubmissionRefused(
            f"{shown_name(name)[1:-1]} is {kind}, whatever its name says: {advice(kind)}."
        )
    try:
        if is_zip:
            _read_zip(file, files)
        else:
            _read_tar(file, files)
    except (
        zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, EOFError, ValueError, OSError,
        RuntimeError,  # NotImplementedError is one: zipfile's for a method that it cannot unpack
    ) as error:  # fmt: skip
        if isinstance(error, RecursionError):  # a RuntimeError, but no statement about the archive
            raise
        raise SubmissionRefused(DAMAGED_MESSAGE) from None


def packed_limit(packed: int) -> int:
    """Returns how many bytes an archive of ``packed`` bytes may unpack to."""
    return min(MAX_UNPACKED_BYTES, max(65_536, packed * MAX_COMPRESSION_RATIO))


_ZIP_MAGIC: Final = b"PK\x03\x04"
_MAGIC: Final = (b"\x1f\x8b", b"BZh", b"\xfd7zXZ\x00")
"""First bytes of gzip, bzip2 and xz."""


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


def _read_zip(file: BinaryIO, files: SubmittedFiles) -> None:
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


class _Decompressor(Protocol):
    @property
    def eof(self) -> bool: ...

    @property
    def needs_input(self) -> bool: ...

    @property
    def unused_data(self) -> bytes: ...

    def decompress(self, data: bytes, max_length: int, /) -> bytes: ...


class _GzipDecompressor:
    """zlib's decompressor of gzip, with the methods of those of bz2 and lzma."""

    def __init__(self) -> None:
        self._inner = zlib.decompressobj(16 + zlib.MAX_WBITS)

    @property
    def eof(self) -> bool:
        return self._inner.eof

    @property
    def needs_input(self) -> bool:
        return not self._inner.unconsumed_tail

    @property
    def unused_data(self) -> bytes:
        return self._inner.unused_data

    def decompress(self, data: bytes, max_length: int, /) -> bytes:
        return self._inner.decompress(self._inner.unconsumed_tail + data, max_length)


def _decompressor(start: bytes) -> _Decompressor | None:
    """Returns the decompressor for a stream that starts like this; None for one that is not compressed."""
    if start.startswith(_MAGIC[0]):
        return _GzipDecompressor()
    if start.startswith(_MAGIC[1]):
        return bz2.BZ2Decompressor()
    if start.startswith(_MAGIC[2]):
        return lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=MAX_DICTIONARY_BYTES)
    return None


class CountingStream:
    """A stream out of a file that may be compressed. Every byte that comes out counts, whatever it is for."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        size = file.seek(0, 2)
        file.seek(0)
        self._left = packed_limit(size)
        self._buffer = b""
        self._chunks = self._unpack()

    def read(self, size: int) -> bytes:
        """Reads up to ``size`` bytes; fewer only at the stream's end."""
        parts: list[bytes] = []
        while size > 0:
            if not self._buffer:
                self._buffer = next(self._chunks, b"")
                if not self._buffer:
                    break
            parts.append(self._buffer[:size])
            self._buffer = self._buffer[size:]
            size -= len(parts[-1])
        return b"".join(parts)

    def skip(self, size: int) -> None:
        """Reads and discards ``size`` bytes. Raises EOFError if the stream ends before."""
        while size > 0:
            count = len(self.read(min(size, READ_SIZE)))
            if not count:
                raise EOFError
            size -= count

    def _unpack(self) -> Iterator[bytes]:
        data = self._file.read(READ_SIZE)
        decompressor = _decompressor(data)
        while data or decompressor is not None:
            chunk = data if decompressor is None else decompressor.decompress(data, READ_SIZE)
            self._left -= len(chunk)
            if self._left < 0:
                raise SubmissionRefused(BOMB_MESSAGE)
            if chunk:
                yield chunk
            if decompressor is None or (not decompressor.eof and decompressor.needs_input):
                data = self._file.read(READ_SIZE)
                if not data and decompressor is not None:
                    raise EOFError("cut off")
            elif decompressor.eof:  # another compressed stream may follow
                data = decompressor.unused_data
                data += self._file.read(READ_SIZE - len(data)) if len(data) < READ_SIZE else b""
                decompressor = _decompressor(data)
                if decompressor is None:
                    return
            else:
                data = b""


_EXTENDED_HEADERS: Final = (
    tarfile.GNUTYPE_LONGNAME,
    tarfile.GNUTYPE_LONGLINK,
    tarfile.XHDTYPE,
    tarfile.XGLTYPE,
    tarfile.SOLARIS_XHDTYPE,
)


def _read_tar(file: BinaryIO, files: SubmittedFiles) -> None:
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
            content = stream.read(_padded(header.size))[: header.size]
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
        stream.skip(_padded(length) if has_content else 0)
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
    stream.skip(_padded(length) - length)


def _padded(size: int) -> int:
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
