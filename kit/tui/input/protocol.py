"""The kitty keyboard protocol, as far as the kit needs it.

https://sw.kovidgoyal.net/kitty/keyboard-protocol/#progressive-enhancement

Asks the terminal about its keyboard from outside a full-screen app, within a time limit.
"""

from __future__ import annotations

import os
import re
import select
import termios
import time
import tty
from dataclasses import dataclass
from typing import Final

ASK_FLAGS: Final = "\x1b[?u"
"""Answered ``CSI ? flags u`` by a terminal that knows the protocol, by others not at all."""
ASK_ATTRIBUTES: Final = "\x1b[c"
"""Answered ``CSI ? ... c`` by every terminal, after all that was asked before: whoever has been silent is silent."""

PUSH_ALL: Final = "\x1b[>27u"
"""Flags 1 disambiguate, 2 event types, 8 all keys as sequences, 16 their text. Textual pushes all but 2."""
POP: Final = "\x1b[<u"
"""Undoes one push. To be said before leaving the alternate screen: each screen has its own stack."""

RELEASES_ON: Final = "\x1b[=2;2u"
"""Sets flag 2 in what was pushed last."""
RELEASES_OFF: Final = "\x1b[=2;3u"
"""Clears flag 2."""

_NEEDED: Final = 2 | 8


def reports_releases(flags: int | None) -> bool:
    """Whether a terminal with these flags says when a letter key goes up: flag 2, and 8 or it is for other keys."""
    return flags is not None and flags & _NEEDED == _NEEDED


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
