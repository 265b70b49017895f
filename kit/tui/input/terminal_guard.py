"""Restores the terminal however the program ends."""

from __future__ import annotations

import atexit
import os
import select
import signal
import termios
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from types import FrameType
from typing import Any, Final

from kit.tui.input.protocol import POP

RESTORE: Final = (
    "\x1b\\"  # ends a string that was being sent; ends nothing otherwise
    "\x1b[?2026l"  # no synchronised output
    "\x1b[?1000l\x1b[?1002l\x1b[?1003l\x1b[?1015l\x1b[?1006l\x1b[?1016l"  # no mouse, by whatever encoding
    "\x1b[?2048l\x1b[?2004l\x1b[?1004l"  # no size reports, no bracketed paste, no focus reports
    "\x1b[?7h"  # lines wrap
    f"{POP}"
    "\x1b[0m\x1b[?1049l\x1b[?25h"  # plain text, the main screen, a visible cursor
)
"""All that a full-screen app must undo. Its parts are harmless where they were not on, but for the pop."""

FATAL: Final = (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
"""Signals that end the process with nothing cleaned up. asyncio sees to SIGINT."""

_PATIENCE: Final = 0.2
"""Seconds to wait for a terminal that does not take what we write."""


def restore_terminal(input_fd: int, output_fd: int, attributes: list[Any] | None) -> None:
    """Makes the terminal sane by system calls alone, so that a signal handler or an exit hook may call it.

    ``attributes`` is what ``termios.tcgetattr`` said before, None where the input is no terminal. A terminal
    that is gone is no error.
    """
    with suppress(OSError):
        if select.select([], [output_fd], [], _PATIENCE)[1]:
            os.write(output_fd, RESTORE.encode())
    if attributes is not None:
        with suppress(termios.error):
            termios.tcsetattr(input_fd, termios.TCSANOW, attributes)
            termios.tcflush(input_fd, termios.TCIFLUSH)


class TerminalGuard:
    """Armed while an app has the terminal: if the process dies, the terminal is restored first.

    It restores on the FATAL signals and at interpreter exit. A signal that was ignored stays ignored, a
    handler that was there is called afterwards, and otherwise the process dies of the signal, as it should.

    ``leave``: called with the number of the first signal whose handler raises KeyboardInterrupt, in place of that, which
    would break off whatever the app is doing.
    """

    def __init__(self, input_fd: int, output_fd: int, leave: Callable[[int], object] | None = None) -> None:
        self._leave = leave
        self._input = input_fd
        self._output = output_fd
        self._attributes: list[Any] | None = None
        self._previous: dict[int, Any] = {}
        self._armed = False

    @property
    def armed(self) -> bool:
        return self._armed

    def arm(self) -> None:
        """Remembers how the terminal is now."""
        if self._armed:
            return
        try:
            self._attributes = termios.tcgetattr(self._input)
        except termios.error:
            self._attributes = None
        self._armed = True
        atexit.register(self._give_back)
        if threading.current_thread() is threading.main_thread():
            for number in FATAL:
                if signal.getsignal(number) is not signal.SIG_IGN:
                    self._previous[number] = signal.signal(number, self._on_signal)

    def disarm(self) -> None:
        """The app has cleaned up by itself. Handlers that others installed meanwhile stay."""
        self._armed = False
        atexit.unregister(self._give_back)
        for number, handler in self._previous.items():
            if signal.getsignal(number) == self._on_signal:
                signal.signal(number, handler)
        self._previous.clear()

    def _give_back(self) -> None:
        """Restores the terminal, once, and for good: what other threads still want to draw goes nowhere."""
        if not self._armed:
            return
        self._armed = False
        terminal = self._output
        with suppress(OSError):  # closed: nobody can draw then, and the input is still to be restored
            terminal = os.dup(self._output)
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._output)
        restore_terminal(self._input, terminal, self._attributes)

    @staticmethod
    def _interrupt(handler: Callable[[], object], leave: Callable[[], object]) -> None:
        """Calls a handler, and leaves the app in place of raising KeyboardInterrupt. The app gives the terminal back itself
        when it has ended; sooner, its thread that reads keys could wait for a whole line."""
        try:
            handler()
        except KeyboardInterrupt:
            leave()

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        previous = self._previous.get(number)
        leave, self._leave = self._leave, None
        if callable(previous) and leave is not None:
            try:
                self._interrupt(partial(previous, number, frame), partial(leave, number))
            except BaseException:
                self._give_back()
                raise
            return
        self._give_back()
        if callable(previous):
            previous(number, frame)
        else:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
