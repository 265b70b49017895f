"""A file of lines that grows: half a line that a killed program left is cut off, so that no later one is joined to it.

The file may be somebody else's: what is read of it at once has a limit.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final

from kit.plain_files import open_plain_file

MAX_LINE_BYTES: Final = 1 << 20
"""Bytes of a line with its end; longer ones are passed over."""
MAX_READ_BYTES: Final = 64 << 20
"""Bytes that are read at once. Of a file that has more, the end is read."""


class LineReader:
    """Reads the whole lines of a file as they come, each once."""

    def __init__(self, file: Path, *, from_now: bool = False) -> None:
        """``from_now``: leave out the whole lines that are in the file already. Raises OSError."""
        self._file = file
        self._offset = 0
        if from_now and file.exists():
            with open_plain_file(file) as opened:
                self._offset = _end_of_last_line(opened)

    def read_new(self) -> Iterator[bytes]:
        """The lines written since the last call, without their ends; none while there is no file. Raises OSError."""
        try:
            opened = open_plain_file(self._file)
        except FileNotFoundError:
            return
        with opened:
            size = os.fstat(opened.fileno()).st_size
            if skips := size - self._offset > MAX_READ_BYTES:
                self._offset = size - MAX_READ_BYTES
            opened.seek(self._offset)
            while self._offset < size:
                line = opened.readline(MAX_LINE_BYTES)
                is_whole = line.endswith(b"\n")
                if not is_whole and len(line) < MAX_LINE_BYTES:  # it is being written
                    return
                self._offset += len(line)
                if is_whole and not skips:
                    yield line[:-1]
                skips = not is_whole


class LineLog:
    """Appends lines to a file, each at once."""

    def __init__(self, file: BinaryIO) -> None:
        """``file``: open for reading and appending, ``a+b``. Raises OSError, also where it ends in more than a line may have."""
        self._handle = file.fileno()
        whole = _end_of_last_line(file)
        self.was_cut = whole < file.seek(0, os.SEEK_END)
        """Whether there was half a line."""
        if self.was_cut:
            file.truncate(whole)

    def append(self, line: bytes) -> None:
        """Adds a line, given without its end. Raises OSError if the disk is full; nothing of it stands in the file then."""
        start, content = os.fstat(self._handle).st_size, line + b"\n"
        try:
            while content:
                content = content[os.write(self._handle, content) :]
        except OSError:
            os.truncate(self._handle, start)
            raise


def _end_of_last_line(file: BinaryIO) -> int:
    """Where the last whole line ends [bytes]. Raises OSError where the half line after it is longer than a line may be."""
    size = file.seek(0, os.SEEK_END)
    begin = max(0, size - MAX_LINE_BYTES)
    file.seek(begin)
    end = file.read(MAX_LINE_BYTES).rfind(b"\n") + 1
    if begin and not end:
        raise OSError(errno.EFBIG, f"it ends in a line of more than {MAX_LINE_BYTES >> 20} MiB", file.name)
    return begin + end
