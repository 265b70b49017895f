"""Gives a program that is run by hand a terminal: a pseudo-terminal of its own, shown in the user's.

What the user types goes to the program's terminal, and what appears there goes to the user's. The program may switch
its own to raw mode, or leave it so when it is killed: the user's is restored in every case. Ctrl-Z suspends the kit, and
the program with it, since it runs in lock-step.
"""

from __future__ import annotations

import fcntl
import os
import select
import signal
import sys
import termios
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Final, Self

GRACE_S: Final = 3.0
"""How long a program may take to end after Ctrl-C before the kit ends it [s]."""

_READ_SIZE: Final = 4096
_LINE_FLAGS: Final = termios.ICANON | termios.ECHO | termios.ISIG | termios.IEXTEN
_INPUT_FLAGS: Final = termios.IXON | termios.ICRNL | termios.INLCR | termios.IGNCR
_IFLAG, _LFLAG, _CC = 0, 3, 6


@dataclass(frozen=True, slots=True)
class ProgramStreams:
    """Descriptors that a program gets as its standard streams; None: nothing to read, output collected by the kit."""

    stdin: int | None = None
    stdout: int | None = None
    stderr: int | None = None

    def descriptors(self) -> tuple[int | None, int | None, int | None]:
        """The three in the order of their numbers: 0, 1 and 2."""
        return self.stdin, self.stdout, self.stderr


class ProgramTerminal:
    """A pseudo-terminal for one program, shown in the user's terminal while the context lasts.

    ``streams`` are to be given to the program. ``shows_output``: its output goes straight to the terminal, not
    through the kit. ``on_interrupt`` is called, in another thread, when the program has been sent Ctrl-C's signal; it
    then has GRACE_S to end. Without it, Ctrl-C interrupts the kit at once. A program in raw mode reads Ctrl-C itself.
    """

    def __init__(self, *, shows_output: bool, on_interrupt: Callable[[], object] | None = None) -> None:
        self.on_interrupt = on_interrupt
        self.was_interrupted = False
        """Whether the program was sent Ctrl-C's signal."""
        self._shows_output = shows_output
        self._deadline: float | None = None

    def __enter__(self) -> Self:
        self._settings = termios.tcgetattr(0)
        self._output = os.dup(1) if os.isatty(1) else os.open(os.ctermid(), os.O_WRONLY | os.O_NOCTTY)
        self._controller, self._slave = os.openpty()
        os.set_blocking(self._controller, False)
        termios.tcsetattr(self._slave, termios.TCSANOW, self._settings)
        self._copy_window_size()
        self._wake_reader, self._wake_writer = os.pipe()
        self._pump_thread = threading.Thread(target=self._pump, name="terminal", daemon=True)
        self._old_handler = signal.signal(signal.SIGWINCH, self._on_resize)
        self._set_raw()
        self._pump_thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        os.write(self._wake_writer, b"x")
        self._pump_thread.join()
        self._show_output()  # what a program wrote that has ended
        self._restore()
        signal.signal(signal.SIGWINCH, self._old_handler)
        for descriptor in (
            self._controller,
            self._slave,
            self._output,
            self._wake_reader,
            self._wake_writer,
        ):
            os.close(descriptor)

    @property
    def streams(self) -> ProgramStreams:
        """The streams to give to the program."""
        if not self._shows_output:
            return ProgramStreams(self._slave)
        return ProgramStreams(
            self._slave, self._slave if os.isatty(1) else None, self._slave if os.isatty(2) else None
        )

    def _set_raw(self) -> None:
        """Lets every key through at once. Output is still translated, so that the kit's own lines begin on the left."""
        raw = termios.tcgetattr(0)
        raw[_LFLAG] &= ~_LINE_FLAGS
        raw[_IFLAG] &= ~_INPUT_FLAGS
        raw[_CC][termios.VMIN], raw[_CC][termios.VTIME] = 1, 0
        termios.tcsetattr(0, termios.TCSADRAIN, raw)

    def _restore(self) -> None:
        with suppress(termios.error):  # the terminal has gone
            termios.tcsetattr(0, termios.TCSADRAIN, self._settings)

    def _copy_window_size(self) -> None:
        with suppress(OSError):  # a terminal that has no size
            size = fcntl.ioctl(0, termios.TIOCGWINSZ, bytes(8))
            fcntl.ioctl(self._controller, termios.TIOCSWINSZ, size)

    def _on_resize(self, number: int, frame: object) -> None:
        self._copy_window_size()

    def _pump(self) -> None:
        """Copies both ways until the context ends. Runs in a thread of its own: the kit may wait for the program."""
        poller = select.poll()
        for descriptor in (0, self._controller, self._wake_reader):
            poller.register(descriptor, select.POLLIN)
        while True:
            wait_s = None if self._deadline is None else max(0.0, self._deadline - time.monotonic())
            ready = [descriptor for descriptor, _ in poller.poll(None if wait_s is None else wait_s * 1000)]
            if self._deadline is not None and time.monotonic() >= self._deadline:
                self._deadline = None
                os.kill(os.getpid(), signal.SIGINT)
            if self._controller in ready:
                self._show_output()
            if 0 in ready and not self._pass_on_keys():
                poller.unregister(0)
            if self._wake_reader in ready:
                return

    def _show_output(self) -> None:
        """Writes to the user's terminal what has appeared on the program's."""
        with suppress(BlockingIOError):
            while data := os.read(self._controller, _READ_SIZE):
                rest = memoryview(data)
                while rest:
                    rest = rest[os.write(self._output, rest) :]

    def _pass_on_keys(self) -> bool:
        """Sends the program what was typed; False at the end of the user's terminal."""
        try:
            data = os.read(0, _READ_SIZE)
        except OSError:  # it has hung up
            data = b""
        settings = termios.tcgetattr(self._slave)
        signals = bool(settings[_LFLAG] & termios.ISIG)
        interrupt, suspend = settings[_CC][termios.VINTR], settings[_CC][termios.VSUSP]
        part = b""
        for byte in (data[place : place + 1] for place in range(len(data))):
            if signals and byte == suspend:
                self._suspend()
            elif signals and byte == interrupt:
                self._send(part)
                part = b""
                self._interrupt(byte)
            else:
                part += byte
        self._send(part)
        return bool(data)

    def _send(self, data: bytes) -> None:
        with suppress(BlockingIOError):  # the program does not read, and its terminal is full
            os.write(self._controller, data)

    def _interrupt(self, byte: bytes) -> None:
        """Handles Ctrl-C: the first one goes to the program, if somebody looks after it; the next one to the kit."""
        if self.on_interrupt is None or self.was_interrupted:
            os.kill(os.getpid(), signal.SIGINT)
            return
        self.was_interrupted = True
        self._deadline = time.monotonic() + GRACE_S
        self._send(byte)
        self.on_interrupt()

    def _suspend(self) -> None:
        """Suspends the kit as Ctrl-Z would; returns when it is in the foreground again."""
        self._restore()
        signal.pthread_kill(threading.get_ident(), signal.SIGTSTP)
        self._set_raw()
        self._copy_window_size()


def has_user_terminal() -> bool:
    """True if this process's standard input is a terminal that it may read: it is not in the background."""
    try:
        return os.isatty(0) and os.tcgetpgrp(0) == os.getpgrp() and sys.stdin.fileno() == 0
    except (OSError, ValueError, AttributeError):  # no standard input, or one that was replaced
        return False


def piped_streams() -> ProgramStreams:
    """The standard input of this process for its program, where it is a pipe or a file; else nothing."""
    try:
        return ProgramStreams(0) if sys.stdin.fileno() == 0 and not os.isatty(0) else ProgramStreams()
    except (OSError, ValueError, AttributeError):  # likewise
        return ProgramStreams()
