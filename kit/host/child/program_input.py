"""The standard input of a program that is run by hand: while it waits for a key or a line, the world goes on.

A thread that reads cannot answer the kit's ticks. Whatever reads through Python's usual ways (``input()``,
``sys.stdin``, ``os.read``, ``select.select``) is therefore marked while it waits, and the graph's waiter answers
without it. A library that reads the terminal in C, such as curses, is not marked: it must be run in a thread beside the
one that spins.
"""

from __future__ import annotations

import builtins
import functools
import io
import os
import select
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from typing import Any, Final

STDIN: Final = 0

Waiting = Callable[[], AbstractContextManager[None]]
"""Makes a context in which the calling thread waits for the user."""


class DeferredInterrupts:
    """Ctrl-C's signal: raises KeyboardInterrupt, but not in the middle of a frame of the protocol."""

    def __init__(self) -> None:
        self._depth = 0
        self._is_pending = False
        self.are_asked = False
        """Whether the kit has asked the program to end."""

    def install(self) -> None:
        """Handles the signal from now on."""
        signal.signal(signal.SIGINT, self._on_signal)

    def ask(self) -> None:
        """Asks the program to end, from any thread: the main thread gets the signal, whatever it waits for."""
        self.are_asked = True
        main = threading.main_thread().ident
        assert main is not None
        signal.pthread_kill(main, signal.SIGINT)

    @contextmanager
    def deferred(self) -> Iterator[None]:
        """Keeps the signal for the end of the context, if this is the main thread, which receives it."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        self._depth += 1
        try:
            yield
        finally:
            self._depth -= 1
        if self._is_pending and not self._depth:
            self._is_pending = False
            raise KeyboardInterrupt

    def _on_signal(self, number: int, frame: object) -> None:
        if self._depth:
            self._is_pending = True
        else:
            raise KeyboardInterrupt


class _Wakeup:
    """A pipe into which every signal writes: one that comes just before a wait ends the wait all the same."""

    def __init__(self) -> None:
        self._reader, writer = os.pipe()
        for descriptor in (self._reader, writer):
            os.set_blocking(descriptor, False)
        signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
        self._select, self._read = select.select, os.read

    def select(self, readers: list[Any], writers: Any, others: Any, timeout: float | None) -> Any:
        """Waits as ``select.select`` does; the handler of a signal runs at once, and may raise."""
        end = None if timeout is None else time.monotonic() + timeout
        while True:
            left = None if end is None else max(0.0, end - time.monotonic())
            ready, *rest = self._select([*readers, self._reader], writers, others, left)
            if self._reader not in ready:
                return ready, *rest
            with suppress(BlockingIOError):
                self._read(self._reader, 64)

    def wait_for_input(self) -> None:
        """Waits until the standard input has something, or has ended."""
        self.select([STDIN], (), (), None)


class _MarkedReader(io.RawIOBase):
    """Reads the standard input, marked."""

    def __init__(self, waiting: Waiting, wakeup: _Wakeup) -> None:
        super().__init__()
        self._waiting, self._wakeup = waiting, wakeup

    def readable(self) -> bool:
        return True

    def fileno(self) -> int:
        return STDIN

    def isatty(self) -> bool:
        return os.isatty(STDIN)

    def readinto(self, buffer: Any) -> int:
        with self._waiting():
            self._wakeup.wait_for_input()
            return os.readv(STDIN, [buffer])


def mark_reading(waiting: Waiting) -> None:
    """Marks every wait for the standard input from now on."""
    wakeup = _Wakeup()
    sys.stdin = io.TextIOWrapper(
        io.BufferedReader(_MarkedReader(waiting, wakeup)), encoding="utf-8", errors="surrogateescape"
    )
    builtins.input = _marked_input(builtins.input, waiting, wakeup)
    os.read = _marked_read(os.read, waiting, wakeup)
    select.select = _marked_select(waiting, wakeup)


def _marked_input(original: Callable[..., str], waiting: Waiting, wakeup: _Wakeup) -> Callable[..., str]:
    @functools.wraps(original)
    def marked_input(prompt: object = "", /) -> str:
        if not os.isatty(STDIN):
            return original(prompt)
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        # To the terminal itself: where the output goes through the kit, it goes line by line, and a prompt is none.
        os.write(STDIN, str(prompt).encode("utf-8", "replace"))
        with waiting():
            wakeup.wait_for_input()
            return original()

    return marked_input


def _marked_read(
    original: Callable[[int, int], bytes], waiting: Waiting, wakeup: _Wakeup
) -> Callable[[int, int], bytes]:
    def read(fd: int, length: int, /) -> bytes:
        if fd != STDIN:
            return original(fd, length)
        with waiting():
            wakeup.wait_for_input()
            return original(fd, length)

    return read


def _marked_select(waiting: Waiting, wakeup: _Wakeup) -> Callable[..., Any]:
    def marked_select(rlist: Any, wlist: Any, xlist: Any, timeout: float | None = None, /) -> Any:
        readers = list(rlist)
        if timeout == 0 or not any(_is_stdin(each) for each in readers):
            return wakeup.select(readers, wlist, xlist, timeout)
        with waiting():
            return wakeup.select(readers, wlist, xlist, timeout)

    return marked_select


def _is_stdin(reader: Any) -> bool:
    return reader == STDIN if isinstance(reader, int) else reader.fileno() == STDIN
