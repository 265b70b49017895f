"""Collects what a student's program prints: up to a limit, line by line, without control characters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

from kit.host.wire import printable

Stream: TypeAlias = Literal["out", "err"]

MAX_LINE = 2000
"""Characters of a line; the rest of a longer one is left out."""

MAX_DUMP_LINES = 500
"""Lines that are kept of Python's stack dump."""

_DUMP = re.compile(
    r"Fatal Python error: |(?:Current thread|Thread) 0x[0-9a-f]+ .*\(most recent call first\):$"
)
_FRAME = re.compile(r'  File "(?P<file>.+)", line (?P<line>[0-9]{1,9}) in (?P<function>\S+)$')


class OutputLine(NamedTuple):
    """A printed line, without control characters."""

    stream: Stream
    text: str


class StackPosition(NamedTuple):
    """Where a program was: file, line and function."""

    file: str
    line: int
    function: str


@dataclass(frozen=True, slots=True)
class ProgramOutput:
    """Lines in the order in which they came, and how many bytes were dropped."""

    lines: Sequence[OutputLine] = ()
    dropped: int = 0

    @property
    def omission(self) -> str:
        """The line that says how many bytes were dropped; empty if none were."""
        return f"({self.dropped:,} bytes more were printed and are left out)" if self.dropped else ""


class OutputCollector:
    """Collects the two streams of one program. Not more than ``limit`` bytes wait to be taken."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._partial_lines: dict[Stream, bytes] = {"out": b"", "err": b""}
        self._lines: list[OutputLine] = []
        self._size = 0
        self._dropped = 0
        self._dump: list[str] = []

    def feed(self, stream: Stream, data: bytes) -> None:
        """Adds what was read from a stream."""
        *lines, rest = (self._partial_lines[stream] + data).split(b"\n")
        for line in lines:
            self._add(stream, line)
        self._partial_lines[stream] = rest[: MAX_LINE * 4]
        self._dropped += max(0, len(rest) - MAX_LINE * 4)

    def finish(self) -> None:
        """Completes lines without an end: the program has ended."""
        for stream, rest in self._partial_lines.items():
            if rest:
                self._add(stream, rest)
            self._partial_lines[stream] = b""

    def take(self) -> ProgramOutput:
        """Removes and returns what has been added since the last call."""
        printed = ProgramOutput(tuple(self._lines), self._dropped)
        self._lines, self._size, self._dropped = [], 0, 0
        return printed

    def position(self, folder: str) -> StackPosition | None:
        """Returns where in the files of ``folder`` the program was at Python's last stack dump; None without one.

        Python's faulthandler writes the stack of each thread, innermost call first. A thread that was in the
        student's own code is preferred to one that waits in the kit's.
        """
        stacks: list[list[re.Match[str]]] = []
        for line in self._dump:
            if _DUMP.match(line):
                stacks.append([])
            elif stacks and (frame := _FRAME.match(line)):
                stacks[-1].append(frame)
        inside = _as_dumped(folder) + "/"
        stacks.sort(key=lambda stack: not (stack and stack[0]["file"].startswith(inside)))
        for stack in stacks:
            for frame in stack:
                if frame["file"].startswith(inside):
                    file = printable(frame["file"].removeprefix(inside))
                    return StackPosition(file, int(frame["line"]), printable(frame["function"]))
        return None

    def _add(self, stream: Stream, line: bytes) -> None:
        text = line[: MAX_LINE * 4].decode("utf-8", "replace").rstrip("\r")
        if stream == "err" and (self._dump or _DUMP.match(text)):
            self._dump += [text] if len(self._dump) < MAX_DUMP_LINES else []
        elif self._size + len(line) > self._limit:
            self._dropped += len(line) + 1
        else:
            self._size += len(line) + 1
            kept = text[:MAX_LINE]
            if len(text) > MAX_LINE:
                self._dropped += len(line) - len(kept.encode())
            self._lines.append(OutputLine(stream, printable(kept)))


def _as_dumped(path: str) -> str:
    """Returns a path as faulthandler writes it."""
    return path.encode("ascii", "backslashreplace").decode("ascii")
