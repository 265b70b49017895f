"""A file of lines that grows: half a line that a killed program left is cut off, so that no later one is joined to it."""

from __future__ import annotations

import os
from typing import BinaryIO


def whole_lines(content: bytes) -> int:
    """Returns the size of the whole lines at the start [bytes].

    >>> whole_lines(b"one\\ntw")
    4
    """
    return content.rfind(b"\n") + 1


class LineLog:
    """Appends lines to a file, each at once."""

    def __init__(self, file: BinaryIO) -> None:
        """``file``: open for reading and appending, ``a+b``. Raises OSError."""
        self._handle = file.fileno()
        file.seek(0)
        content = file.read()
        whole = whole_lines(content)
        self.was_cut = whole < len(content)
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
