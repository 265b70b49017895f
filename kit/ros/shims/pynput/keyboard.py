"""The part of pynput that packages of Flatland's time import."""

from __future__ import annotations

from enum import Enum
from typing import Any

from kit.ros.execution.context import get_default_context, log_as_kit

Key = Enum(
    "Key",
    "alt alt_l alt_r backspace caps_lock cmd ctrl ctrl_l ctrl_r delete down end enter esc home insert left "
    "page_down page_up right shift shift_l shift_r space tab up",
)


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


class Listener:
    """A listener that never receives a key; it logs that when it starts."""

    def __init__(self, on_press: Any = None, on_release: Any = None, **_: Any) -> None:
        self.running = False

    def start(self) -> None:
        self.running = True
        log_as_kit(
            "pynput is not installed, and there is no desktop whose keys it could read: this listener hears nothing. "
            "What is pressed in the kit is published on /teleopkeys by the kit itself",
            is_warning=True,
        )

    def stop(self) -> None:
        self.running = False

    def join(self, timeout: float | None = None) -> None:
        """Waits for the end of the program."""
        context = get_default_context()
        context.graph.wait(lambda: not self.running or not context.ok(), what="Listener.join()")

    def __enter__(self) -> Listener:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
