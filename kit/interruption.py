"""Ends a verb at SIGTERM and SIGHUP as at Ctrl-C, and lets what is being written become whole before any of them.

SIGHUP is what a process gets when its terminal or the connection to it is gone.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any, Final

ENDING: Final = (signal.SIGTERM, signal.SIGHUP)
"""The signals that end a process that does nothing about them, and that are sent for that."""


SAME_END_S: Final = 1.0
"""Signals that come so soon after one that ends a program are the same end, as of a shell that sends several [s]."""
REPEAT_S: Final = 0.01
"""A signal that was lost is sent again after this long [s]."""


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Has SIGTERM and SIGHUP interrupt the main thread as Ctrl-C does, by KeyboardInterrupt, until the context ends.

    If one has come, the context ends by SystemExit, with 128 and the signal's number, as shells have it; output to a
    terminal that is gone does not change that. One that is lost in a callback of C code is sent again, Ctrl-C too. A signal that is ignored, as under ``nohup``, stays ignored, and one for
    which there is a handler keeps it. In other threads than the main one the context does nothing.

    >>> import signal
    >>> @ended_by_signals()
    ... def work() -> None:
    ...     try:
    ...         signal.raise_signal(signal.SIGTERM)
    ...     except KeyboardInterrupt:
    ...         print("what there is is kept")
    >>> work()
    Traceback (most recent call last):
    SystemExit: 143
    """
    received: list[int] = []
    ends_at: list[float] = []
    owner = os.getpid()

    def interrupt(number: int, frame: FrameType | None) -> None:
        if os.getpid() != owner:  # a fork, which has nothing to keep
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
            return
        if ends_at and time.monotonic() < ends_at[0] + SAME_END_S:
            return
        if number in ENDING:
            received.append(number)
            if not ends_at and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
                signal.signal(signal.SIGINT, interrupt)
        ends_at[:] = [time.monotonic()]
        raise KeyboardInterrupt

    replaced = []
    if threading.current_thread() is threading.main_thread():
        replaced = [number for number in ENDING if signal.getsignal(number) is signal.SIG_DFL]
    for number in replaced:
        signal.signal(number, interrupt)
    hook = sys.unraisablehook

    def repeat(problem: sys.UnraisableHookArgs) -> None:
        """Ctrl-C or a signal that came while a library's C code called Python, as pymunk's steps do, is lost there."""
        if os.getpid() != owner or not issubclass(problem.exc_type, KeyboardInterrupt):
            hook(problem)
            return
        is_sent = False
        while not is_sent:
            with suppress(
                KeyboardInterrupt
            ):  # it came before this had returned, where it is lost as well: once more
                ends_at.clear()  # it has ended nothing
                number = received[0] if received else signal.SIGINT
                again = threading.Timer(REPEAT_S, os.kill, (owner, number))
                again.daemon = True
                again.start()
                is_sent = True

    sys.unraisablehook = repeat
    try:
        yield
    except SystemExit as stop:  # its class may say more, as ScreenClosed's does
        if received:
            write_out()
            stop.code = 128 + received[0]
        raise
    except (KeyboardInterrupt, OSError):
        if not received:
            raise
    finally:
        sys.unraisablehook = hook
        for number in replaced:
            signal.signal(number, signal.SIG_DFL)
        if signal.getsignal(signal.SIGINT) is interrupt:
            signal.signal(signal.SIGINT, signal.default_int_handler)
    if received:
        write_out()
        raise SystemExit(128 + received[0])


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Keeps Ctrl-C, SIGTERM and SIGHUP waiting until the context ends, for what has to be written whole.

    Python handles signals in the main thread alone: in another one there is nothing to keep away.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[int] = []

    def keep(number: int, frame: FrameType | None) -> None:
        waiting.append(number)

    previous: dict[int, Any] = {}
    try:
        for number in (signal.SIGINT, *ENDING):
            handler = signal.getsignal(number)
            if handler is not None and handler is not signal.SIG_IGN:
                previous[number] = handler
                signal.signal(number, keep)
        yield
    finally:
        for kept, handler in previous.items():
            signal.signal(kept, handler)
        if waiting:
            signal.raise_signal(waiting[0])


def write_out() -> None:
    """Writes what the standard streams hold. What a terminal that is gone does not take is lost, without an error at the exit."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (OSError, ValueError, AttributeError):  # gone, closed, or not there
            with suppress(OSError, ValueError, AttributeError):
                null = os.open(os.devnull, os.O_WRONLY)
                os.dup2(null, stream.fileno())
                os.close(null)
