"""Textual's Linux driver and key parser, with key release on request; it restores the terminal on every exit."""

from __future__ import annotations

import asyncio
import atexit
import os
import re
import select
import signal
import termios
import threading
import time
from codecs import getincrementaldecoder
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import partial
from types import FrameType
from typing import TYPE_CHECKING, Any, Final

from textual import constants, events
from textual._xterm_parser import _MAX_SEQUENCE_SEARCH_THRESHOLD, XTermParser
from textual.app import App
from textual.drivers.linux_driver import LinuxDriver
from textual.keys import Keys

from kit.tui.input.modes import base_key
from kit.tui.input.protocol import ASK_ATTRIBUTES, ASK_FLAGS, POP, RELEASES_OFF, RELEASES_ON

if TYPE_CHECKING:
    from textual.message import Message


_KEY: Final = re.compile(
    r"\x1b\[(?P<code>\d*)(?::[\d:]*)?(?:;(?P<modifiers>\d*)(?::(?P<kind>\d*))?(?P<text>;[\d:]*)?)?"
    r"(?P<end>[u~ABCDEFHPQRS])"
)
_ANSWER: Final = re.compile(r"\x1b\[\?(?P<numbers>[\d;]*)(?P<end>[uc])")
_LONG_ANSWER: Final = re.compile(r"\x1b\[\?[\d;]*")
_REPEAT, _RELEASE = "2", "3"


class KeyReleased(events.InputEvent):
    """A key went up. ``key`` is the name under which its press arrived, whatever the modifiers are by now.

    Textual hands presses to the widget in focus and these to the screen, so they may arrive before their press;
    ``time`` tells.
    """

    def __init__(self, key: str) -> None:
        super().__init__()
        self.key = key


class KeyRepeated(events.InputEvent):
    """A key is still down and the keyboard repeats it.

    Not a subclass of ``events.Key``: Textual names handlers after classes, so ``on_key`` would not see it.
    """

    def __init__(self, key: str, character: str | None = None) -> None:
        super().__init__()
        self.key = key
        self.character = character


class KeyboardAnswer(events.InputEvent):
    """The terminal's answer to ``CSI ? u CSI c``: its keyboard flags, None if it knows no such thing."""

    key: Final = ""
    """The parser looks at the key of whatever it passes on."""

    def __init__(self, flags: int | None) -> None:
        super().__init__()
        self.flags = flags


class KeyParser(XTermParser):
    """Yields what XTermParser yields, and KeyReleased, KeyRepeated and KeyboardAnswer."""

    def __init__(self, debug: bool = False) -> None:
        self._names: dict[str, str] = {}
        self._flags: int | None = None
        self._in_long_answer = False
        super().__init__(debug)

    def _sequence_to_key_events(  # type: ignore[override]  # XTermParser reads only .key of what comes out of here
        self, sequence: str, alt: bool = False
    ) -> Iterable[events.InputEvent]:
        if self._in_long_answer and not sequence.startswith("\x1b"):
            if sequence not in "0123456789;":
                self._in_long_answer = False
                yield self._answer(sequence, "")
            return
        self._in_long_answer = False
        if match := _ANSWER.fullmatch(sequence):
            yield self._answer(match["end"], match["numbers"])
        elif len(sequence) == _MAX_SEQUENCE_SEARCH_THRESHOLD and _LONG_ANSWER.fullmatch(sequence):
            # One more character and XTermParser would type all of it out. Windows Terminal's answer is 38 long.
            self._in_long_answer = True
            yield _ignored(sequence)
        elif match := _KEY.fullmatch(sequence):
            yield from self._key_events(match, sequence, alt)
        else:
            yield from super()._sequence_to_key_events(sequence, alt)

    def _key_events(self, match: re.Match[str], sequence: str, alt: bool) -> Iterable[events.InputEvent]:
        """The events of one key sequence. XTermParser would raise ValueError at a kind or an alternate."""
        code, kind = match["code"], match["kind"]
        if ":" in sequence:
            sequence = f"\x1b[{code};{match['modifiers'] or ''}{match['text'] or ''}{match['end']}"
        place = (code or "1") + match["end"]  # an arrow goes down as CSI A and up as CSI 1;1:3A
        for event in super()._sequence_to_key_events(sequence, alt):
            if kind == _RELEASE:
                yield KeyReleased(self._names.pop(place, base_key(event.key)))
            elif kind == _REPEAT:
                yield KeyRepeated(self._names.get(place, event.key), event.character)
            else:
                self._names[place] = event.key
                yield event

    def _answer(self, end: str, numbers: str) -> events.InputEvent:
        """Keyboard flags are kept until the device attributes, asked for last, say that all has been answered."""
        if end == "u":
            self._flags = int(numbers.partition(";")[0] or 0)
        elif end == "c":
            flags, self._flags = self._flags, None
            return KeyboardAnswer(flags)
        return _ignored(numbers + end)


def _ignored(sequence: str) -> events.Key:
    """What XTermParser itself yields for a sequence that means nothing to the app."""
    return events.Key(Keys.Ignore, sequence)


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
