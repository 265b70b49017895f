"""Streams out of files that may be compressed: every byte that comes out counts, as it comes."""

from __future__ import annotations

import bz2
import lzma
import zlib
from collections.abc import Iterator
from typing import BinaryIO, Final, Protocol

from grader.submitted_files import READ_SIZE, SubmissionRefused

MAX_UNPACKED_BYTES: Final = 128 * 1024 * 1024
"""Bytes out of a compressed stream: headers, needed files, and those that are passed over."""
MAX_COMPRESSION_RATIO: Final = 200
"""Unpacked to packed bytes: text packs to a tenth, a bomb to a thousandth."""
MAX_STREAMS: Final = 10_000
"""Compressed streams behind each other in one file, where each may be empty; a program that writes many, for random access,
puts 64 KiB into each."""
MAX_DICTIONARY_BYTES: Final = 96 * 1024 * 1024
"""Memory for unpacking xz, whose highest preset needs 65 MiB."""

BOMB_MESSAGE: Final = (
    "It unpacks to far more than a program needs, or is a decompression bomb; hand in only your program."
)


def packed_limit(packed: int) -> int:
    """Returns how many bytes an archive of ``packed`` bytes may unpack to."""
    return min(MAX_UNPACKED_BYTES, max(65_536, packed * MAX_COMPRESSION_RATIO))


COMPRESSION_MAGIC: Final = (b"\x1f\x8b", b"BZh", b"\xfd7zXZ\x00")
"""First bytes of gzip, bzip2 and xz."""


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
    if start.startswith(COMPRESSION_MAGIC[0]):
        return _GzipDecompressor()
    if start.startswith(COMPRESSION_MAGIC[1]):
        return bz2.BZ2Decompressor()
    if start.startswith(COMPRESSION_MAGIC[2]):
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
        parts = 1
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
                parts += 1
                if parts > MAX_STREAMS:
                    raise SubmissionRefused(BOMB_MESSAGE)
                data = decompressor.unused_data
                data += self._file.read(READ_SIZE - len(data)) if len(data) < READ_SIZE else b""
                decompressor = _decompressor(data)
                if decompressor is None:
                    return
            else:
                data = b""
