"""Lines from standard input, waited for in such a way that something else can be seen to meanwhile."""

from __future__ import annotations

import os
import select
import sys
import time
from collections.abc import Callable
from typing import Final

CHUNK: Final = 1 << 16


class Intake:
    """What has come in at standard input and nobody has asked for yet: who reads after another goes on there."""

    def __init__(self) -> None:
        self.begun = b""
        self.has_ended = False
        try:
            self.descriptor = None if sys.stdin is None else sys.stdin.fileno()
        except (OSError, ValueError):  # io.UnsupportedOperation is both
            self.descriptor = None

    @property
    def has_line(self) -> bool:
        """Whether asking for a line would not wait; the end counts as one."""
        return self.descriptor is None or b"\n" in self.begun or self.has_ended


class Lines:
    """Standard input, line by line. Close it when done.

    ``wake`` may be called in any thread; whoever waits in ``next`` then calls ``on_wake`` in its own thread. Where
    standard input is no file (a test's text) it is read as it is, for it never makes anybody wait. ``intake``: of
    who read before.
    """

    def __init__(self, on_wake: Callable[[], object], intake: Intake | None = None) -> None:
        self._on_wake = on_wake
        self._intake = Intake() if intake is None else intake
        self._woken, self._bell = os.pipe()
        os.set_blocking(self._woken, False)
        os.set_blocking(self._bell, False)
        self._is_closed = False

    def wake(self) -> None:
        """From any thread; more often than heeded does no harm."""
        try:
            if not self._is_closed:
                os.write(self._bell, b"!")
        except OSError:  # full: it has been heard already; or closed just now
            pass

    def await_line(self, seconds: float | None = None) -> bool:
        """Waits until ``next`` would not, at most so long; by default for ever. Whether it would not."""
        intake = self._intake
        until = None if seconds is None else time.monotonic() + seconds
        poller = select.poll()
        for descriptor in (intake.descriptor, self._woken):
            if descriptor is not None:
                poller.register(descriptor, select.POLLIN)
        while not intake.has_line:
            left = None if until is None else max(0.0, until - time.monotonic())
            ready = [descriptor for descriptor, _ in poller.poll(None if left is None else 1000.0 * left)]
            if self._woken in ready:
                os.read(self._woken, CHUNK)
                self._on_wake()
            if intake.descriptor is not None and intake.descriptor in ready:
                data = os.read(intake.descriptor, CHUNK)
                intake.begun += data
                intake.has_ended = not data
            elif left == 0.0:
                break
        return intake.has_line

    def next(self) -> str | None:
        """The next line without its end; None when there are no more."""
        intake = self._intake
        if intake.descriptor is None:
            line = "" if sys.stdin is None else sys.stdin.readline()
            return line.rstrip("\n") if line else None
        self.await_line()
        said, end, intake.begun = intake.begun.partition(b"\n")
        return said.decode("utf-8", "replace") if said or end else None

    def close(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            os.close(self._woken)
            os.close(self._bell)
