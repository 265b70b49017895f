"""Asks the terminal about its keyboard from outside a full-screen app, within a time limit."""

from __future__ import annotations

import os
import re
import select
import termios
import time
import tty
from dataclasses import dataclass
from typing import Final

from kit.tui.input.protocol import ASK_ATTRIBUTES, ASK_FLAGS, POP, PUSH_ALL, reports_releases

_FLAGS: Final = re.compile(rb"\x1b\[\?(\d+)u")
_ATTRIBUTES: Final = re.compile(rb"\x1b\[\?[\d;]*c")


@dataclass(frozen=True, slots=True)
class KeyboardReport:
    """``flags``: of the kitty protocol, with all that the kit uses asked for; None if the terminal has none of it.

    ``seconds``: until the answer; None if there was no answer at all.
    """

    flags: int | None
    seconds: float | None

    @property
    def releases(self) -> bool:
        """Whether this terminal reports key releases."""
        return reports_releases(self.flags)


def ask_keyboard(input_fd: int, output_fd: int, limit: float = 1.0) -> KeyboardReport:
    """Asks, and waits up to ``limit`` seconds. Leaves the terminal as it was.

    Raises OSError if the terminal is not ours to ask: none there, or the process is in the background.
    """
    try:
        before = termios.tcgetattr(input_fd)
    except termios.error as error:
        raise OSError(*error.args) from None
    if os.tcgetpgrp(input_fd) != os.getpgrp():
        raise OSError("this process is in the background")
    received, started, answered = b"", time.monotonic(), False
    try:
        tty.setcbreak(input_fd, termios.TCSANOW)  # no echo, and Ctrl-C still interrupts
        os.write(output_fd, (PUSH_ALL + ASK_FLAGS + POP + ASK_ATTRIBUTES).encode())
        while not answered and (left := started + limit - time.monotonic()) > 0:
            # In slices: a Ctrl-C just before the call does not end it, and Python acts on it only after.
            if select.select([input_fd], [], [], min(left, 0.1))[0]:
                received += os.read(input_fd, 1024)
                answered = _ATTRIBUTES.search(received) is not None
        seconds = time.monotonic() - started
    finally:
        termios.tcsetattr(input_fd, termios.TCSAFLUSH, before)
    match = _FLAGS.search(received)
    return KeyboardReport(int(match[1]) if match else None, seconds if answered else None)
