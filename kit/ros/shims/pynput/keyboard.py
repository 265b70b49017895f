"""The part of pynput that packages of Flatland's time import, on a terminal's keys.

A terminal tells when a key is pressed, not when it is released: a key counts as released when another one is pressed, or
when it has not been repeated for a while.
"""

from __future__ import annotations

import os
import select
import termios
import threading
import tty
from collections.abc import Iterator
from enum import Enum
from typing import Any, Final

from kit.ros.execution.context import get_default_context, log_as_kit

Key = Enum(
    "Key",
    "alt alt_l alt_r backspace caps_lock cmd ctrl ctrl_l ctrl_r delete down end enter esc home insert left "
    "page_down page_up right shift shift_l shift_r space tab up",
)

STDIN: Final = 0
FIRST_REPEAT_S: Final = 0.6
"""How long after its first press a key counts as held [s]: terminals begin to repeat after half a second."""
NEXT_REPEAT_S: Final = 0.15
"""How long after a repetition [s]."""
SEQUENCE_S: Final = 0.05
"""How long the rest of an arrow key's sequence may take [s]; else it was the escape key."""

_NAMED: Final = {
    "\r": Key["enter"],
    "\n": Key["enter"],
    "\t": Key["tab"],
    " ": Key["space"],
    "\x7f": Key["backspace"],
    "\b": Key["backspace"],
    "\x1b": Key["esc"],
    **{f"\x1b{kind}{letter}": Key[name] for kind in "[O" for letter, name in
       zip("ABCDHF", ("up", "down", "right", "left", "home", "end"), strict=True)},
    **{f"\x1b[{number}~": Key[name] for number, name in
       zip("12345678", ("home", "insert", "delete", "end", "page_up", "page_down", "home", "end"), strict=True)},
}  # fmt: skip


class KeyCode:
    """A key by its character."""

    def __init__(self, vk: int | None = None, char: str | None = None) -> None:
        self.vk, self.char = vk, char

    @classmethod
    def from_char(cls, char: str) -> KeyCode:
        return cls(char=char)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, KeyCode) and other.char == self.char

    def __hash__(self) -> int:
        return hash(self.char)

    def __repr__(self) -> str:
        return repr(self.char)


class Listener:
    """Calls ``on_press`` and ``on_release`` with the keys of the program's terminal, in a thread of its own.

    A callback that returns False ends it, as in pynput. Without a terminal it hears nothing, and logs that when it starts.
    """

    def __init__(self, on_press: Any = None, on_release: Any = None, **_: Any) -> None:
        self.running = False
        self._on_press, self._on_release = on_press, on_release
        self._held: Any = None
        self._problem: Exception | None = None

    def start(self) -> None:
        self.running = True
        if os.isatty(STDIN):
            # From now on each key passes on at once; Ctrl-C still interrupts.
            settings = termios.tcgetattr(STDIN)
            tty.setcbreak(STDIN)
            threading.Thread(target=self._run, args=(settings,), name="keyboard", daemon=True).start()
            return
        log_as_kit(
            "pynput is not installed, and there is no desktop or terminal whose keys it could read: this listener hears "
            "nothing. What is pressed in the kit is published on /teleopkeys by the kit itself",
            is_warning=True,
        )

    def stop(self) -> None:
        self.running = False
        get_default_context().graph.notify()

    def join(self, timeout: float | None = None) -> None:
        """Waits until it has stopped, or for the end of the program. Raises what a callback has raised."""
        context = get_default_context()
        until = None if timeout is None else context.graph.now_ns + int(timeout * 1e9)
        context.graph.wait(lambda: not self.running or not context.ok(), until, what="Listener.join()")
        if self._problem is not None:
            problem, self._problem = self._problem, None
            raise problem

    def wait(self) -> None:
        """No-op: it is ready at once."""

    def __enter__(self) -> Listener:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _run(self, settings: list[Any]) -> None:
        try:
            self._read_keys()
        except Exception as problem:  # noqa: BLE001 - join() raises it in the program's own thread, as pynput does
            self._problem = problem
        termios.tcsetattr(STDIN, termios.TCSANOW, settings)
        self.stop()

    def _read_keys(self) -> None:
        wait_s: float | None = None
        while self.running:
            if not select.select([STDIN], [], [], wait_s)[0]:
                self._release()
                wait_s = None
                continue
            data = os.read(STDIN, 1024)
            if not data:
                return
            if data == b"\x1b" and select.select([STDIN], [], [], SEQUENCE_S)[0]:
                data += os.read(STDIN, 1024)
            for key in _keys(data.decode("utf-8", "replace")):
                is_repeated = key == self._held
                if not is_repeated:
                    self._release()
                wait_s = NEXT_REPEAT_S if is_repeated else FIRST_REPEAT_S
                self._held = key
                self._call(self._on_press, key)

    def _release(self) -> None:
        if self._held is not None and self.running:
            key, self._held = self._held, None
            self._call(self._on_release, key)

    def _call(self, callback: Any, key: Any) -> None:
        if self.running and callback is not None and callback(key) is False:
            self.running = False


def _keys(text: str) -> Iterator[Any]:
    """Splits what was read into keys."""
    while text:
        length = next((size for size in (4, 3) if text[:size] in _NAMED), 1)
        yield _NAMED.get(text[:length]) or KeyCode.from_char(text[:length])
        text = text[length:]
