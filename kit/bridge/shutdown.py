"""Ends the process of a bridge for certain, after its robots were told to stop, even where something hangs.

A package of a wire may wait for a peer that is gone, and may keep threads of its own that the interpreter waits for. So
a thread that waits for nothing of theirs keeps the time, and the signals reach it directly: the main thread may be in a
call that never returns.
"""

from __future__ import annotations

import faulthandler
import os
import select
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Final, Self

import kit
from kit.bridge.channels import Report

SHUTDOWN_LIMIT_S: Final = 10.0
"""Longer than Zenoh takes to close a session whose peer no longer reads."""
EXIT_HUNG: Final = 3
"""Exit code of a process that had to be ended because something in it hung."""
EXIT_INTERRUPTED: Final = 128 + signal.SIGINT
ATTEMPT_S: Final = 0.5
"""How long the last steps before the exit may take: each could hang too [s]."""
LAST_RESORT_S: Final = 3.0
"""Time after which the process is ended without Python's help, if the interpreter no longer runs [s]."""
SIGNALS: Final = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_BEGIN: Final = 0
_CANCEL: Final = 255
_KIT_FOLDER: Final = Path(kit.__file__).parent


class ShutdownDeadline:
    """Ends the process ``limit_s`` seconds after its end has begun, unless it has ended by itself until then.

    The end begins with Ctrl-C, SIGTERM or SIGHUP, which raise KeyboardInterrupt in the main thread, with ``begin``, or
    at the end of the ``with`` statement, from where on the interpreter's own end is watched. Ctrl-C during the end ends
    the process at once. Enter it in the main thread; only ``cancel`` takes it back, which nothing but a test needs.

    ``report`` gets what hangs, in a line for people; ``exit_process`` gets the exit code.
    """

    def __init__(
        self,
        report: Report,
        *,
        limit_s: float = SHUTDOWN_LIMIT_S,
        exit_process: Callable[[int], object] = os._exit,
    ) -> None:
        self._report = report
        self._limit_s = limit_s
        self._exit_process = exit_process
        self._at_begin: Callable[[], object] = lambda: None
        self._before_exit: Callable[[], object] = lambda: None
        self._has_stopped_robots = threading.Event()
        self._is_interrupted = False
        self._handlers_before: dict[int, object] = {}
        self._read_end, self._write_end = os.pipe()
        os.set_blocking(self._write_end, False)
        self._thread = threading.Thread(target=self._watch, name="bridge-shutdown", daemon=True)

    def __enter__(self) -> Self:
        self._handlers_before = {number: signal.signal(number, self._interrupt) for number in SIGNALS}
        signal.set_wakeup_fd(self._write_end, warn_on_full_buffer=False)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.begin()

    def at_begin(self, stop_robots: Callable[[], object]) -> None:
        """Calls ``stop_robots()`` as soon as the end begins, in a thread of its own."""
        self._at_begin = stop_robots

    def before_exit(self, restore: Callable[[], object]) -> None:
        """Calls ``restore()`` before the process is ended, for what the main thread may not come to any more."""
        self._before_exit = restore

    def begin(self) -> None:
        """Starts the deadline. May be called in any thread, and again."""
        self._send(_BEGIN)

    def cancel(self) -> None:
        """Takes everything back: the process goes on."""
        signal.set_wakeup_fd(-1)
        for number, handler in self._handlers_before.items():
            signal.signal(number, handler)  # type: ignore[arg-type]  # what signal.signal has returned
        self._send(_CANCEL)
        self._thread.join()
        faulthandler.cancel_dump_traceback_later()
        os.close(self._read_end)
        os.close(self._write_end)

    def _send(self, byte: int) -> None:
        os.write(self._write_end, bytes([byte]))

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        """Ends as Ctrl-C does, once: a second signal is for the thread, and must not disturb the end."""
        if not self._is_interrupted:
            self._is_interrupted = True
            raise KeyboardInterrupt

    # In the thread

    def _watch(self) -> None:
        if self._next_byte(None) == _CANCEL:
            return
        end = time.monotonic() + self._limit_s
        # Where native code holds the interpreter's lock, no thread of Python's runs, and this one's time never comes.
        faulthandler.dump_traceback_later(
            self._limit_s + LAST_RESORT_S, exit=True, file=sys.__stderr__ or sys.stderr
        )
        stopping = threading.Thread(target=self._stop_robots, name="bridge-last-stop", daemon=True)
        stopping.start()
        while (byte := self._next_byte(end - time.monotonic())) is not None:
            if byte == _CANCEL:
                return
            if byte in SIGNALS:
                stopping.join(ATTEMPT_S)
                self._end(EXIT_INTERRUPTED)
                return
        _attempt(lambda: self._report(self._describe()))
        self._end(EXIT_HUNG)

    def _next_byte(self, timeout_s: float | None) -> int | None:
        """Reads what comes next through the pipe: a signal's number, or what ``_send`` has sent; None if nothing has come."""
        wait_s = None if timeout_s is None else max(0.0, timeout_s)
        is_there = bool(select.select([self._read_end], [], [], wait_s)[0])
        return os.read(self._read_end, 1)[0] if is_there else None

    def _stop_robots(self) -> None:
        self._at_begin()
        self._has_stopped_robots.set()

    def _end(self, code: int) -> None:
        _attempt(self._before_exit)
        self._exit_process(code)

    def _describe(self) -> str:
        """Says what hangs, and whether the robots know that they are to stop."""
        robots = (
            "The robots were told to stop."
            if self._has_stopped_robots.is_set()
            else "Stopping the robots hangs too: use their emergency stops!"
        )
        return (
            f"The bridge did not end within {self._limit_s:g} s: {_what_hangs()}. {robots} "
            f"The process is ended now, with exit code {EXIT_HUNG}."
        )


def _attempt(action: Callable[[], object]) -> None:
    """Waits for an action for a limited time: a terminal may have stopped its output."""
    thread = threading.Thread(target=action, name="bridge-attempt", daemon=True)
    thread.start()
    thread.join(ATTEMPT_S)


def _what_hangs() -> str:
    """Says where the main thread is, in the kit's own code if it is there, and which threads the interpreter waits for."""
    main = threading.main_thread()
    frame = sys._current_frames().get(main.ident or 0)
    stack = traceback.extract_stack(frame)
    own = [each for each in stack if Path(each.filename).is_relative_to(_KIT_FOLDER)]
    place = (own or list(stack))[-1]
    text = f"it hangs in {place.name} ({place.filename}, line {place.lineno})"
    others = [each.name for each in threading.enumerate() if each is not main and not each.daemon]
    return text + (f", and these threads still run: {', '.join(others)}" if others else "")
