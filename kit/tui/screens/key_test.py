"""The key test: press keys and see what arrives, what the kit makes of it, and in which mode."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Container, Vertical
from textual.widgets import Static

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.tui.input.drive import DriveState
from kit.tui.input.drive_keys import DRIVE_KEYS, DriveKey
from kit.tui.input.modes import Clock, KeyEventKind
from kit.tui.input.screen import DriveScreen
from kit.tui.rows.key_rows import bindings
from kit.tui.terminal import TerminalDecision

ROOMY: Final = (140, 34)
"""Columns and rows of a terminal in which all keys stand below each other, with room between them."""
_BAR, _LONG_BAR = 4, 40
_TABLE_ROWS: Final = 7
_KEPT: Final = 50
"""Lines of the log: more than any screen shows."""
_WORDS: Final = MappingProxyType(
    {
        KeyEventKind.PRESS: "press",
        KeyEventKind.REPEAT: "repeat",
        KeyEventKind.RELEASE: "release",
        None: "timeout",
    }
)


@dataclass(frozen=True, slots=True)
class KeyLogEntry:
    """One line of the log: what came, how long [s] after the one before, and the messages it caused."""

    kind: KeyEventKind | None
    key: str
    gap: float | None
    messages: tuple[str, ...]

    def __str__(self) -> str:
        gap = f"+{1000 * self.gap:.0f} ms" if self.gap is not None and self.gap < 10 else ""
        return f"{gap:>8}  {_WORDS[self.kind]:<8} {self.key:<18} {' '.join(self.messages)}".rstrip()


class KeyTestScreen(DriveScreen):
    """Shows what a key press becomes on this terminal. In ASCII, and drawn only when something comes."""

    CSS = """
    KeyTestScreen Static { width: 1fr; height: auto; padding: 0 1; }
    KeyTestScreen #title { text-style: bold; }
    KeyTestScreen #mode { height: 2; }
    KeyTestScreen #log { height: 1fr; margin-top: 1; }
    KeyTestScreen #parts, KeyTestScreen #table { height: auto; }
    KeyTestScreen #parts { height: 1fr; layout: vertical; }
    KeyTestScreen.-roomy #parts { layout: horizontal; align-horizontal: center; margin-top: 2; }
    KeyTestScreen.-roomy #table { width: 76; height: 1fr; }
    KeyTestScreen.-roomy #mode { height: 4; }
    KeyTestScreen.-roomy #log { width: 60; margin-top: 0; }
    """
    screen_actions = ScreenActions(
        "key test",
        ("drive_mode", "close_key_test", "quit"),
        own=(
            letter("close_key_test", "x", "close", "close the key test"),
        ),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(self, terminal: TerminalDecision | None = None, clock: Clock = time.monotonic) -> None:
        super().__init__(terminal, clock)
        self._log: deque[KeyLogEntry] = deque(maxlen=_KEPT)
        self._last: float | None = None

    def compose(self) -> ComposeResult:
        yield Static(
            "Key test: press and hold keys     z key mode   x close   ^C quit", id="title", markup=False
        )
        with Container(id="parts"):
            with Vertical(id="table"):
                yield Static(self._mode_text(), id="mode", markup=False)
                yield Static(self._table_text(), id="keys", markup=False)
            yield Static(id="log", markup=False)

    def on_resize(self, event: events.Resize) -> None:
        """A large terminal shows the keys in one column with longer bars, and what arrived beside them."""
        self.set_class(event.size.width >= ROOMY[0] and event.size.height >= ROOMY[1], "-roomy")
        self.query_one("#keys", Static).update(self._table_text())

    def action_close_key_test(self) -> None:
        self.dismiss()

    def key_received(self, kind: KeyEventKind | None, key: str, messages: tuple[str, ...]) -> None:
        now = self._clock()
        self._log.appendleft(
            KeyLogEntry(kind, key, None if self._last is None else now - self._last, messages)
        )
        self._last = now
        self.query_one("#log", Static).update("\n".join(map(str, self._log)))
        self.drive_status_changed()

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        self.query_one("#keys", Static).update(self._table_text())

    def drive_status_changed(self) -> None:
        self.query_one("#mode", Static).update(self._mode_text())

    def _mode_text(self) -> str:
        if self.drive.timeouts is None:
            return self.drive.status
        first, later = (round(1000 * seconds) for seconds in self.drive.timeouts)
        return f"{self.drive.status}\nup when silent for {first} ms after a press, {later} ms after a repeat"

    def _table_text(self) -> str:
        held = self.drive.state.held
        if self.has_class("-roomy"):
            return "\n\n".join(_cell(row, held.get(row.name, 0.0), _LONG_BAR) for row in DRIVE_KEYS)
        cells = [_cell(row, held.get(row.name, 0.0), _BAR) for row in DRIVE_KEYS]
        right = [*cells[_TABLE_ROWS:], *[""] * _TABLE_ROWS]
        return "\n".join(
            f"{one}  {two}".rstrip() for one, two in zip(cells[:_TABLE_ROWS], right, strict=False)
        )


def _cell(row: DriveKey, strength: float, length: int) -> str:
    """A key, a bar of up to ``length`` for how strongly it pushes, and its message."""
    bar = "#" * max(round(length * strength), 1 if strength else 0)
    return f"{row.label:<11} [{bar:<{length}}] {row.pressed:<9}"
