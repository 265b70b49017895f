"""A terminal to run the kit's apps in: a real pseudo-terminal, and on our side of it what a terminal would do."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest

_ENTER = """
import fcntl, runpy, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
del sys.argv[0]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
"""Makes the terminal the program's own, as a login does, and becomes the program."""

PROGRAMS = Path(__file__).parent / "programs"

KITTY_ATTRIBUTES = b"\x1b[?62;52;c"


class Modes:
    """What an app has switched on in a terminal: private modes, and keyboard flags, one stack for each screen."""

    def __init__(self) -> None:
        self.on: set[int] = {7, 25}
        self.stacks: dict[bool, list[int]] = {False: [], True: []}
        self.flags: dict[bool, int] = {False: 0, True: 0}

    @property
    def alternate(self) -> bool:
        return 1049 in self.on

    @property
    def keyboard(self) -> int:
        return self.flags[self.alternate]

    def private(self, numbers: list[int], on: bool) -> None:
        """``CSI ? numbers h`` or ``l``."""
        (self.on.update if on else self.on.difference_update)(numbers)

    def flag(self, verb: bytes, numbers: list[int]) -> None:
        """``CSI > numbers u`` and its like."""
        screen = self.alternate
        if verb == b">":
            self.stacks[screen].append(self.flags[screen])
            self.flags[screen] = numbers[0]
        elif verb == b"<":
            self.flags[screen] = self.stacks[screen].pop() if self.stacks[screen] else -1
        elif verb == b"=":
            old, (new, how) = self.flags[screen], numbers
            self.flags[screen] = {1: new, 2: old | new, 3: old & ~new}[how]


class Terminal:
    """Our side of a pseudo-terminal, and a program on the other side.

    ``kitty``: whether it knows the keyboard protocol. ``attributes``: its answer to ``CSI c``, None for silence.
    ``environment``: variables besides the usual ones. ``on_the_way``: keys that it sends just before it learns that releases are no longer wanted.
    The program may report to us with JSON lines, to the file descriptor named by REPORT in its environment.
    """

    _SEQUENCE = re.compile(
        rb"\x1b\[(?:(?P<question>\?u|c|6n)|\?(?P<switched>[\d;]+)(?P<switch>[hl])|(?P<verb>[<>=])(?P<flags>[\d;]*)u)"
    )

    def __init__(
        self,
        *program: str,
        kitty: bool = True,
        attributes: bytes | None = KITTY_ATTRIBUTES,
        on_the_way: bytes = b"",
        environment: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.on_the_way = on_the_way
        self.kitty, self.attributes = kitty, attributes
        self.modes = Modes()
        self.output = b""
        self.reports: list[Any] = []
        self._followed = 0
        self._pending = b""
        self.fd, self.other_fd = pty.openpty()
        fcntl.ioctl(self.other_fd, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        self.attributes_before = termios.tcgetattr(self.other_fd)
        self._reports_fd, report_fd = os.pipe()
        self.process = subprocess.Popen(
            [sys.executable, "-c", _ENTER, *program],
            stdin=self.other_fd,
            stdout=self.other_fd,
            stderr=self.other_fd,
            env={
                # The size is the terminal's business, but pytest-xdist's workers carry one in their environment.
                **{name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")},
                "TERM": "xterm-256color",
                "REPORT": str(report_fd),
                "TEXTUAL_ANIMATIONS": "none",
                **environment,
            },
            pass_fds=[report_fd],
            start_new_session=True,
        )
        os.close(report_fd)

    def send(self, data: bytes) -> None:
        os.write(self.fd, data)

    def pump(self, seconds: float = 0.0) -> int:
        """Takes what the program says, waiting for a while at most, and answers as a terminal does.

        Returns how many bytes came.
        """
        count = 0
        readable = select.select([self.fd, self._reports_fd], [], [], seconds)[0]
        if self.fd in readable:
            with contextlib.suppress(OSError):
                data = os.read(self.fd, 65536)
                count += len(data)
                self.output += data
                self._follow()
        if self._reports_fd in readable:
            data = os.read(self._reports_fd, 65536)
            count += len(data)
            self._pending += data
            *lines, self._pending = self._pending.split(b"\n")
            self.reports += [json.loads(line) for line in lines]
        return count

    def _follow(self) -> None:
        """Does what is new in the output, and answers each question as things are at that moment."""
        for match in self._SEQUENCE.finditer(self.output, self._followed):
            self._followed = match.end()
            numbers = [
                int(number or 0) for number in (match["switched"] or match["flags"] or b"").split(b";")
            ]
            if match["switch"]:
                self.modes.private(numbers, match["switch"] == b"h")
            elif match["verb"]:
                wanted = self.modes.keyboard & 2
                self.modes.flag(match["verb"], numbers)
                if wanted and not self.modes.keyboard & 2:
                    self.send(self.on_the_way)
            elif match["question"] == b"?u" and self.kitty:
                self.send(b"\x1b[?%du" % self.modes.keyboard)
            elif match["question"] == b"c" and self.attributes:
                self.send(self.attributes)
            elif match["question"] == b"6n":
                self.send(b"\x1b[12;34R")

    def until(self, condition: Callable[[], object], what: str, limit: float = 60.0) -> None:
        end = time.monotonic() + limit
        while not condition():
            assert time.monotonic() < end, (
                f"waited in vain for {what}; reports {self.reports}, end {self.output[-400:]!r}"
            )
            self.pump(0.02)

    def until_reported(self, *wanted: Any) -> None:
        """Waits for these reports, in this order, whatever comes between; forgets all up to the last."""
        for report in wanted:
            self.until(lambda report=report: report in self.reports, repr(report))  # type: ignore[misc]  # mypy on lambdas
            del self.reports[: self.reports.index(report) + 1]

    def wait(self) -> int:
        """The program's exit status, when it has ended and all its output is here."""
        self.until(lambda: self.process.poll() is not None, "the end")
        while self.pump(0.05):
            pass
        return int(self.process.returncode)

    def assert_sane(self) -> None:
        """As before the program: nothing switched on, nothing left to read."""
        assert self.modes.on == {7, 25}
        assert self.modes.stacks == {False: [], True: []}
        assert set(self.modes.flags.values()) == {0}
        assert termios.tcgetattr(self.other_fd) == self.attributes_before
        os.set_blocking(self.other_fd, False)
        with pytest.raises(BlockingIOError):
            os.read(self.other_fd, 1)

    def hang_up(self) -> None:
        """Closes the terminal, as a dropped connection does."""
        for name in ("other_fd", "fd"):
            os.close(getattr(self, name))
            setattr(self, name, -1)  # or the number may be another's when all is closed

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        for descriptor in (self.fd, self.other_fd, self._reports_fd):
            with contextlib.suppress(OSError):
                os.close(descriptor)


@pytest.fixture
def terminal() -> Iterator[Callable[..., Terminal]]:
    """Runs one of the programs beside this file in a terminal of its own."""
    with contextlib.ExitStack() as stack:

        def run(program: str, *arguments: str, **traits: Any) -> Terminal:
            made = Terminal(str(PROGRAMS / program), *arguments, **traits)
            stack.callback(made.close)
            return made

        yield run
