"""Lines from standard input, waited for in such a way that something else can be seen to meanwhile."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Callable
from typing import Final

CHUNK: Final = 1 << 16


class Lines:
    """Standard input, line by line. Close it when done.

    ``wake`` may be called in any thread; whoever waits in ``next`` then calls ``on_wake`` in its own thread. Where
    standard input is no file (a test's text) it is read as it is, for it never makes anybody wait.
    """

    def __init__(self, on_wake: Callable[[], object]) -> None:
        self._on_wake = on_wake
        self._begun = b""
        self._ended = False
        self._woken, self._bell = os.pipe()
        os.set_blocking(self._woken, False)
        os.set_blocking(self._bell, False)
        self._is_closed = False
        try:
            self._input = None if sys.stdin is None else sys.stdin.fileno()
        except (OSError, ValueError):  # io.UnsupportedOperation is both
            self._input = None

    def wake(self) -> None:
        """From any thread; more often than heeded does no harm."""
        try:
            if not self._is_closed:
                os.write(self._bell, b"!")
        except OSError:  # full: it has been heard already; or closed just now
            pass

    def next(self) -> str | None:
        """The next line without its end; None when there are no more."""
        if self._input is None:
            line = "" if sys.stdin is None else sys.stdin.readline()
            return line.rstrip("\n") if line else None
        poller = select.poll()
        for descriptor in (self._input, self._woken):
            poller.register(descriptor, select.POLLIN)
        while b"\n" not in self._begun and not self._ended:
            ready = [descriptor for descriptor, _ in poller.poll()]
            if self._woken in ready:
                os.read(self._woken, CHUNK)
                self._on_wake()
            if self._input in ready:
                data = os.read(self._input, CHUNK)
                self._begun += data
                self._ended = not data
        line, end, self._begun = self._begun.partition(b"\n")
        return line.decode("utf-8", "replace") if line or end else None

    def close(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            os.close(self._woken)
            os.close(self._bell)
