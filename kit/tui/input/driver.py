"""Textual's Linux driver, which asks the terminal for the release of keys."""

from __future__ import annotations

import asyncio
import os
import select
import threading
import time
from codecs import getincrementaldecoder
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from textual import constants
from textual.app import App
from textual.drivers.linux_driver import LinuxDriver

from kit.tui.input.key_parser import KeyboardAnswer, KeyParser
from kit.tui.input.protocol import ASK_ATTRIBUTES, ASK_FLAGS, RELEASES_OFF, RELEASES_ON
from kit.tui.input.terminal_guard import TerminalGuard

if TYPE_CHECKING:
    from textual.message import Message

_LAST_WORDS: Final = 0.25
"""Seconds to wait, when leaving, for what the terminal has already sent."""

_HUNG_UP: Final = 129
"""Exit status of a process whose terminal went away: 128 + SIGHUP."""


class KeyDriver(LinuxDriver):
    """The terminal as the kit uses it."""

    def __init__(
        self,
        app: App[Any],
        *,
        debug: bool = False,
        mouse: bool = True,
        size: tuple[int, int] | None = None,
    ) -> None:
        super().__init__(app, debug=debug, mouse=mouse, size=size)
        assert self._file is not None, "a full-screen app needs its standard error"
        self._guard = TerminalGuard(self.fileno, self._file.fileno(), self._leave)
        self._reporting = False
        self._asked = 0
        self._heard = 0
        self._answered = threading.Event()

    def _leave(self, number: int) -> None:
        """Leaves the app at a signal as a user does, with 128 and its number."""
        try:  # a signal comes to the thread in which it runs, and may come while it waits
            loop = asyncio.get_running_loop()
        except RuntimeError:  # before the app, or after it
            raise KeyboardInterrupt from None
        loop.call_soon_threadsafe(partial(self._app.exit, return_code=128 + number))

    def report_releases(self, on: bool) -> None:
        """Asks the terminal for key release events, or for none.

        Its answer arrives as KeyboardAnswer, at the screen that is active then. Only a screen that drives should
        ask: elsewhere releases are noise, and each costs bytes.
        """
        if constants.DISABLE_KITTY_KEY:
            return
        if on:
            self.write(RELEASES_ON + ASK_FLAGS)
            self._ask_attributes()
        elif self._reporting:
            self.write(RELEASES_OFF)
        self._reporting = on

    def _ask_attributes(self) -> None:
        self._asked += 1
        self.write(ASK_ATTRIBUTES)

    @property
    def has_mouse(self) -> bool:
        """Whether clicks and the wheel arrive here."""
        return self._mouse

    def use_mouse(self, on: bool) -> None:
        """Asks the terminal for clicks and the wheel, or leaves them to it."""
        self._disable_mouse_support()
        self._mouse = on
        self._enable_mouse_support()
        self.flush()

    def _enable_mouse_support(self) -> None:
        """Asks for clicks, the wheel and what is drawn with a button down; Textual asks for every motion, which over SSH is
        sent for nothing."""
        if self._mouse:
            self.write("\x1b[?1000h\x1b[?1002h\x1b[?1006h")
            self.flush()

    def _disable_mouse_support(self) -> None:
        if self._mouse:
            self.write("\x1b[?1006l\x1b[?1002l\x1b[?1000l")
            self.flush()

    def write(self, data: str) -> None:
        """Writes to the terminal while the app has it; afterwards nobody reads, so there is nothing to do."""
        if self._guard.armed and self._writer_thread is not None:
            super().write(data)

    def start_application_mode(self) -> None:
        self._guard.arm()
        super().start_application_mode()  # type: ignore[no-untyped-call]  # LinuxDriver leaves it untyped
        if self._reporting:  # back from a suspension: the flags went with the screen
            self.report_releases(True)

    def stop_application_mode(self) -> None:
        if not self._guard.armed:
            return
        self._await_last_words()
        self.write("\x1b[?1016l")  # LinuxDriver asks for the mouse in pixels and does not take it back
        super().stop_application_mode()
        self.close()  # waits until all is written: what is still queued when the process ends is lost
        self._guard.disarm()

    def _await_last_words(self) -> None:
        """Lets the release of the key that quit arrive here, and not as text in the shell."""
        if not self._heard:  # never asked, or a terminal that does not answer
            return
        if self._reporting:
            self.write(RELEASES_OFF)
        self._ask_attributes()
        end = time.monotonic() + _LAST_WORDS
        while self._heard < self._asked and self._answered.wait(max(0.0, end - time.monotonic())):
            self._answered.clear()

    def process_message(self, message: Message) -> None:
        if isinstance(message, KeyboardAnswer):
            self._heard += 1
            self._answered.set()
        super().process_message(message)

    def run_input_thread(self) -> None:
        """Reads keys until the app stops, the main thread is gone, or the terminal is."""
        parser = KeyParser(self._debug)
        decode = getincrementaldecoder("utf-8")("replace").decode
        while not self.exit_event.is_set() and threading.main_thread().is_alive():
            if select.select([self.fileno], [], [], 0.1)[0]:
                try:
                    data = os.read(self.fileno, 4096)
                except OSError:
                    data = b""
                if not data:
                    self._app.call_later(self._app.exit, return_code=_HUNG_UP)
                    return
                if text := decode(data):
                    for message in parser.feed(text):
                        self.process_message(message)
            for message in parser.tick():
                self.process_message(message)


def key_driver(app: App[Any]) -> KeyDriver | None:
    """The app's driver, if it is ours: in tests without a terminal it is not."""
    driver = app._driver
    return driver if isinstance(driver, KeyDriver) else None
