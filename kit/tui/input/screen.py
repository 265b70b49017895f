"""A Textual screen that drives: asks for key releases while it is active, and stops when it is not."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final, Protocol, runtime_checkable

from textual import events
from textual.app import App
from textual.screen import Screen
from textual.timer import Timer

from kit.tui.input.drive import DriveState, KeyboardDrive, ModeName
from kit.tui.input.drive_keys import base_key, drive_key
from kit.tui.input.driver import key_driver
from kit.tui.input.key_parser import KeyboardAnswer, KeyReleased, KeyRepeated
from kit.tui.input.modes import Clock, KeyEventKind
from kit.tui.terminal import TerminalDecision

_NEXT: Final[Mapping[ModeName | None, ModeName | None]] = MappingProxyType(
    {None: "latch", "latch": "hold", "hold": None, "exact": None}
)


SHORTEST_TIMER: Final = 1e-3
"""Seconds. Textual divides by a timer's interval where the timer comes late, so it must not be 0."""


@runtime_checkable
class DriveModeKeeper(Protocol):
    """An app that keeps how keys drive while its screens come and go."""

    drive_mode: ModeName | None
    """The mode that the user chose, None for automatic."""


class DriveScreen(Screen[None]):
    """Subclasses override ``drive_keys_changed``; they may bind keys that do not drive, as any screen may.

    Keys of the drive table come here first and go no further, unless a focused widget takes them (an input
    field does).
    """

    def __init__(self, terminal: TerminalDecision | None = None, clock: Clock = time.monotonic) -> None:
        super().__init__()
        self.drive: Final = KeyboardDrive(clock)
        self._terminal = terminal
        self._clock = clock
        self._shown = self.drive.state
        self._status = self.drive.status
        self._released: dict[str, float] = {}
        self._alarm: Timer | None = None
        self._alarm_time = math.inf

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        """Called at once when what the keys ask for has changed: messages like ``p_up``, and strengths."""

    def is_drive_key(self, key: str) -> bool:
        """Whether a key drives here; those that do not are left to the screen's bindings."""
        return drive_key(key) is not None

    def key_received(self, kind: KeyEventKind | None, key: str, messages: tuple[str, ...]) -> None:
        """Called for every key that arrives, with the messages it causes, before ``drive_keys_changed``; kind None: a timeout."""

    def drive_status_changed(self) -> None:
        """Called when ``drive.status`` reads differently."""

    def action_drive_mode(self) -> None:
        """Automatic, then latch, then hold, then automatic again; so also on the screens that follow."""
        mode = _NEXT[self.drive.requested_mode]
        if isinstance(self.app, DriveModeKeeper):
            self.app.drive_mode = mode
        self._report_drive(self.drive.choose(mode))

    def stop_driving(self) -> None:
        """All keys up, at once: for a pause, say."""
        self._report_drive(self.drive.stop())

    def on_mount(self) -> None:
        self.watch(self.app, "app_focus", self._focus_changed, init=False)
        self.app.app_suspend_signal.subscribe(self, self._suspended)

    def on_screen_resume(self) -> None:
        if isinstance(self.app, DriveModeKeeper):
            self._report_drive(self.drive.choose(self.app.drive_mode))
        driver = key_driver(self.app)
        if self._terminal is not None and not self._terminal.ask_keyboard.value:
            self._on_terminal_answer(None)
        elif driver is not None:
            driver.report_releases(True)

    def on_screen_suspend(self) -> None:
        driver = key_driver(self.app)
        # A driving screen above us wants them too, and may have asked before we hear of it.
        above = next(reversed(self.app.screen_stack), None)
        if driver is not None and not isinstance(above, DriveScreen):
            driver.report_releases(False)
        self.stop_driving()

    def _focus_changed(self, focus: bool) -> None:
        if not focus:
            self.stop_driving()

    def _suspended(self, app: App[object]) -> None:
        self.stop_driving()

    def on_keyboard_answer(self, event: KeyboardAnswer) -> None:
        self._on_terminal_answer(event.flags)

    def _on_terminal_answer(self, flags: int | None) -> None:
        hidden_by = self._terminal.between.value if self._terminal else None
        self._report_drive(self.drive.terminal_answered(flags, hidden_by))

    def on_key(self, event: events.Key) -> None:
        if not self.is_drive_key(event.key):
            self._report_key(KeyEventKind.PRESS, event.key, ())
            return
        event.stop()
        event.prevent_default()
        if not self.app.app_focus:
            return  # on its way when the focus went; its release is for another window
        messages = self.drive.press(event.key)
        overtaken = event.time < self._released.get(base_key(event.key), -math.inf)
        if overtaken:
            messages += self.drive.release(event.key)
        self._report_key(KeyEventKind.PRESS, event.key, messages)

    def on_key_repeated(self, event: KeyRepeated) -> None:
        takes = self.is_drive_key(event.key)
        self._report_key(KeyEventKind.REPEAT, event.key, self.drive.repeat(event.key) if takes else ())
        if not takes:
            # It does what another press does, as on terminals that do not tell repeats apart.
            self.app.post_message(events.Key(event.key, event.character))

    def on_key_released(self, event: KeyReleased) -> None:
        self._released[base_key(event.key)] = event.time
        self._report_key(KeyEventKind.RELEASE, event.key, self.drive.release(event.key))

    def _report_key(self, kind: KeyEventKind | None, key: str, messages: tuple[str, ...]) -> None:
        self.key_received(kind, key, messages)
        self._report_drive(messages)

    def _report_drive(self, messages: tuple[str, ...]) -> None:
        state = self.drive.state
        if messages or state != self._shown:
            self._shown = state
            self.drive_keys_changed(messages, state)
        if self.drive.status != self._status:
            self._status = self.drive.status
            self.drive_status_changed()
        self._set_alarm()

    def _set_alarm(self) -> None:
        """One timer, for the next timeout; none while no key is down, so that an idle screen does nothing.

        One that rings too early finds nothing to do and sets the next.
        """
        deadline = self.drive.deadline
        if deadline is None or deadline >= self._alarm_time:
            return
        if self._alarm is not None:
            self._alarm.stop()
        self._alarm_time = deadline
        self._alarm = self.set_timer(max(SHORTEST_TIMER, deadline - self._clock()), self._on_alarm)

    def _on_alarm(self) -> None:
        self._alarm, self._alarm_time = None, math.inf
        if messages := self.drive.tick():
            self.key_received(None, "", messages)
        self._report_drive(messages)
