"""Standard input line by line: a reader that other threads can wake, and whose successor goes on with what is unread."""

from __future__ import annotations

import os
import select
import sys
import time
from collections.abc import Callable
from typing import Final

CHUNK: Final = 1 << 16


class InputBuffer:
    """Buffer of unread standard input, shared by successive readers."""

    def __init__(self) -> None:
        self.unread = b""
        self.has_ended = False
        try:
            self.descriptor = None if sys.stdin is None else sys.stdin.fileno()
        except (OSError, ValueError):  # io.UnsupportedOperation is both
            self.descriptor = None

    @property
    def has_line(self) -> bool:
        """Whether a line can be read without waiting; the end of the input counts as one."""
        return self.descriptor is None or b"\n" in self.unread or self.has_ended


class InputLines:
    """Standard input, line by line. Close it when done.

    ``wake`` may be called in any thread; a thread that waits in ``read_line`` then calls ``on_wake``. Where standard
    input is no file (a test's text) it is read without waiting. ``input_buffer``: that of an earlier reader.
    """

    def __init__(self, on_wake: Callable[[], object], input_buffer: InputBuffer | None = None) -> None:
        self._on_wake = on_wake
        self._buffer = InputBuffer() if input_buffer is None else input_buffer
        self._wake_reader, self._wake_writer = os.pipe()
        os.set_blocking(self._wake_reader, False)
        os.set_blocking(self._wake_writer, False)
        self._is_closed = False

    def wake(self) -> None:
        """Wakes the waiting thread; may be called in any thread, and more often than needed."""
        try:
            if not self._is_closed:
                os.write(self._wake_writer, b"!")
        except OSError:  # full: the reader wakes up anyway; or closed just now
            pass

    def wait_for_line(self, seconds: float | None = None) -> bool:
        """Waits for a line, at most ``seconds``, by default for ever; returns whether there is one."""
        input_buffer = self._buffer
        until = None if seconds is None else time.monotonic() + seconds
        poller = select.poll()
        for descriptor in (input_buffer.descriptor, self._wake_reader):
            if descriptor is not None:
                poller.register(descriptor, select.POLLIN)
        while not input_buffer.has_line:
            left = None if until is None else max(0.0, until - time.monotonic())
            ready = [descriptor for descriptor, _ in poller.poll(None if left is None else 1000.0 * left)]
            if self._wake_reader in ready:
                os.read(self._wake_reader, CHUNK)
                self._on_wake()
            if input_buffer.descriptor is not None and input_buffer.descriptor in ready:
                data = os.read(input_buffer.descriptor, CHUNK)
                input_buffer.unread += data
                input_buffer.has_ended = not data
            elif left == 0.0:
                break
        return input_buffer.has_line

    def read_line(self) -> str | None:
        """The next line without its end; None when there are no more."""
        input_buffer = self._buffer
        if input_buffer.descriptor is None:
            line = "" if sys.stdin is None else sys.stdin.readline()
            return line.rstrip("\n") if line else None
        self.wait_for_line()
        line, end, input_buffer.unread = input_buffer.unread.partition(b"\n")
        return line.decode("utf-8", "replace") if line or end else None

    def close(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            os.close(self._wake_reader)
            os.close(self._wake_writer)
