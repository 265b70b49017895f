"""Reads bags that others hand on, with limits on what is unpacked and computed for them.

A few bytes can unpack to gigabytes, and a table of SQLite can be computed while it is read.
"""

from __future__ import annotations

from contextlib import closing
from functools import partial
from types import MappingProxyType, SimpleNamespace
from typing import IO, Any, Final
from urllib.parse import quote

import apsw
import lz4.frame  # type: ignore[import-untyped]  # comes with rosbags, without types
from rosbags.rosbag2 import Reader, ReaderError
from rosbags.rosbag2 import reader as directory_reading
from rosbags.rosbag2 import storage_mcap as mcap_reading
from rosbags.rosbag2.reader import DirectoryReader
from rosbags.rosbag2.storage_mcap import McapReader
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

zstd: Final[Any] = vars(directory_reading)["zstd"]
"""The module that rosbags found: of Python, or its backport."""

MAX_UNPACKED: Final = 256 << 20
"""Of a chunk of MCAP, or of one message [bytes]; ROS 2 writes chunks of 768 KiB."""
MAX_UNPACKED_FILE: Final = 4 << 30
"""Of a file that is compressed as a whole [bytes]."""
_PIECE: Final = 1 << 20
_COMPUTED: Final = """
    SELECT name FROM pragma_table_list WHERE schema = 'main' AND type NOT IN ('table', 'shadow')
    UNION ALL
    SELECT t.name FROM pragma_table_list AS t JOIN pragma_table_xinfo(t.name) AS c
    WHERE t.schema = 'main' AND t.type = 'table' AND c.hidden != 0
"""


class LimitedSqlite3Reader(Sqlite3Reader):
    """Reads ordinary tables alone: no view, virtual table or computed column, whose rows can be without end."""

    def open(self) -> None:
        with closing(
            apsw.Connection(
                f"file:{quote(str(self.path))}?immutable=1",
                flags=apsw.SQLITE_OPEN_READONLY | apsw.SQLITE_OPEN_URI,
            )
        ) as database:
            computed = database.execute(_COMPUTED).fetchone()
        if computed:
            raise ReaderError(f"its table {computed[0]} is computed when it is read")
        super().open()


class LimitedDirectoryReader(DirectoryReader):
    """Reads a folder with the limited readers."""

    STORAGE_PLUGINS = MappingProxyType({"mcap": McapReader, "sqlite3": LimitedSqlite3Reader})


class LimitedReader(Reader):
    """Reads a bag as ``Reader`` does. Raises ReaderError where a limit is passed."""

    STORAGE_PLUGINS = MappingProxyType({"dir": LimitedDirectoryReader})


def _unpack(kind: Any, data: bytes, size: int | None = None) -> bytes:
    """All frames, one after the other. Raises ReaderError if more than ``size`` bytes, or too many, come out."""
    limit = MAX_UNPACKED if size is None else min(size, MAX_UNPACKED)
    unpacked = bytearray()
    while data:
        frame = kind()
        unpacked += frame.decompress(data, limit + 1 - len(unpacked))
        if len(unpacked) > limit:
            raise ReaderError(f"more than {limit} bytes come out of {len(data)}")
        if not frame.eof:
            raise ReaderError("compressed data that is cut off")
        data = frame.unused_data or b""
    return bytes(unpacked)


class _LimitedFile:
    """A file that is read from its start and raises ReaderError where it goes on for too long."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self._left = MAX_UNPACKED_FILE

    def __enter__(self) -> _LimitedFile:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def read(self, size: int = _PIECE) -> bytes:
        data = self._file.read(min(size, _PIECE) if size >= 0 else _PIECE)
        self._left -= len(data)
        if self._left < 0:
            raise ReaderError(f"more than {MAX_UNPACKED_FILE} bytes come out of a compressed file")
        return data


def _open_zstd(file: IO[bytes], mode: str) -> _LimitedFile:
    return _LimitedFile(zstd.open(file, mode))


# The library unpacks by these names, and has no setting for a limit.
mcap_reading.DECOMPRESSORS.update(
    lz4=partial(_unpack, lz4.frame.LZ4FrameDecompressor), zstd=partial(_unpack, zstd.ZstdDecompressor)
)
vars(directory_reading)["zstd"] = SimpleNamespace(
    open=_open_zstd, decompress=partial(_unpack, zstd.ZstdDecompressor)
)
