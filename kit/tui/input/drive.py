"""Converts key events to the dissertation's key messages, whatever the terminal reports of its keys.

Pure: no terminal and no Textual here, and the clock is given.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Literal

from kit.tui.input.drive_keys import drive_key, named
from kit.tui.input.modes import Clock, DriveMode, ExactMode, HoldMode, KeyEventKind, LatchMode
from kit.tui.input.protocol import reports_releases

ModeName = Literal["exact", "hold", "latch"]

_MODES: Final[Mapping[ModeName, Callable[[Clock], DriveMode]]] = MappingProxyType(
    {"exact": ExactMode, "hold": HoldMode, "latch": LatchMode}
)
MODE_TEXTS: Final[Mapping[ModeName, str]] = MappingProxyType(
    {
        "exact": "a key drives while it is down",
        "hold": "a key drives while you hold it",
        "latch": "each press is a step, Space stops",
    }
)
"""What a mode means for the driver, in a few words."""


@dataclass(frozen=True, slots=True)
class DriveState:
    """The keys that are held. ``held``: their message names, and how strongly each pushes, 0 to 1."""

    held: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def linear(self) -> float:
        """Forward +1 to backward -1. Opposite keys cancel."""
        return sum(push * named(name).linear for name, push in self.held.items())

    @property
    def angular(self) -> float:
        """Left (counter-clockwise) +1 to right -1."""
        return sum(push * named(name).angular for name, push in self.held.items())


@dataclass(frozen=True, slots=True)
class ModeChoice:
    mode: ModeName
    reason: str


UNASKED: Final = ModeChoice("hold", "the terminal has not answered yet")


def automatic_mode(flags: int | None, hidden_by: str | None = None) -> ModeChoice:
    """The mode for a terminal that answered with these keyboard flags, None if it does not know them.

    ``hidden_by`` names a program between us and the terminal that keeps releases to itself: tmux, mosh, screen.
    """
    if reports_releases(flags):
        return ModeChoice("exact", "this terminal reports key releases")
    return ModeChoice("hold", f"{hidden_by or 'this terminal'} reports no key releases")


class KeyboardDrive:
    """Reads driving from keys. Every method that may change something returns the key messages it caused.

    Messages and ``state`` agree: ``p_<name>`` when a name enters ``state.held``, ``r_<name>`` when it leaves.
    """

    def __init__(self, clock: Clock = time.monotonic) -> None:
        self._clock = clock
        self._automatic = UNASKED
        self._requested_mode: ModeName | None = None
        self._mode: DriveMode = _MODES[UNASKED.mode](clock)
        self._state = DriveState()

    @property
    def state(self) -> DriveState:
        """State after the last call that returned messages."""
        return self._state

    @property
    def requested_mode(self) -> ModeName | None:
        """The mode the user chose, None for automatic."""
        return self._requested_mode

    @property
    def choice(self) -> ModeChoice:
        """The active mode and why it is."""
        return ModeChoice(self._requested_mode, "your choice") if self._requested_mode else self._automatic

    @property
    def mode_name(self) -> str:
        """The active mode in a few words, and whether the user chose it.

        >>> KeyboardDrive().mode_name
        'hold (automatic)'
        """
        return self._requested_mode or f"{self._automatic.mode} (automatic)"

    @property
    def status(self) -> str:
        """One line for the status bar: the mode, what it means, why; or what would be better."""
        choice = self.choice
        if isinstance(self._mode, HoldMode) and self._mode.rhythm.uneven:
            return "hold: keys arrive unevenly over this link; latch mode would drive better"
        return f"{choice.mode}: {MODE_TEXTS[choice.mode]} ({choice.reason})"

    @property
    def deadline(self) -> float | None:
        """When to call ``tick`` [s of the clock] if no key comes before; None if never."""
        return self._mode.deadline()

    @property
    def timeouts(self) -> tuple[float, float] | None:
        """The silence [s] that releases a key in the mode ``hold``, after its press and after a repeat; None in other modes."""
        if not isinstance(self._mode, HoldMode):
            return None
        return self._mode.rhythm.first_timeout, self._mode.rhythm.next_timeout

    def press(self, key: str) -> tuple[str, ...]:
        """A key as Textual names it. Keys that do not drive change nothing."""
        return self._handle(KeyEventKind.PRESS, key)

    def repeat(self, key: str) -> tuple[str, ...]:
        return self._handle(KeyEventKind.REPEAT, key)

    def release(self, key: str) -> tuple[str, ...]:
        return self._handle(KeyEventKind.RELEASE, key)

    def tick(self) -> tuple[str, ...]:
        """Lets time pass."""
        self._mode.advance()
        return self._changes()

    def stop(self) -> tuple[str, ...]:
        """Releases all keys: the focus is lost, the screen changes, or the world is paused."""
        self._mode.stop()
        return self._changes()

    def terminal_answered(self, flags: int | None, hidden_by: str | None = None) -> tuple[str, ...]:
        """The terminal said what it can (see ``automatic_mode``); the mode follows unless one was chosen."""
        return self._change_mode(self._requested_mode, automatic_mode(flags, hidden_by))

    def choose(self, mode: ModeName | None) -> tuple[str, ...]:
        """Sets the mode that the user chose, None for automatic. Switching to another mode stops the robot first."""
        return self._change_mode(mode, self._automatic)

    def _change_mode(self, wish: ModeName | None, automatic: ModeChoice) -> tuple[str, ...]:
        before = self.choice.mode
        self._requested_mode, self._automatic = wish, automatic
        if self.choice.mode == before:
            return ()
        messages = self.stop()
        self._mode = _MODES[self.choice.mode](self._clock)
        return messages

    def _handle(self, kind: KeyEventKind, key: str) -> tuple[str, ...]:
        if drive_key(key) is None:
            return ()
        late = self.tick()  # a key may have timed out unnoticed just before it is pressed again
        self._mode.handle(kind, key)
        return late + self._changes()

    def _changes(self) -> tuple[str, ...]:
        before, after = self._state.held, self._mode.strengths()
        self._state = DriveState(MappingProxyType(after))
        up = [named(name).released for name in before if name not in after]
        return (*up, *(named(name).pressed for name in after if name not in before))
