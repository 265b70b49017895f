"""The three ways to read driving from keys: ``exact``, ``hold`` and ``latch``."""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Protocol

from kit.tui.input.drive_keys import DriveKey, base_key, drive_key
from kit.tui.input.key_rhythm import KeyState, Rhythm

Clock = Callable[[], float]
"""Seconds, never going back."""

NUDGE: Final = 0.15
"""Seconds for which a fresh press drives at full strength: a tap moves the robot a little, not for 0.6 s."""

BRIDGE: Final = 0.35
"""The strength from then until the keyboard's first repeat shows that the key is held."""
LINEAR_STEPS: Final = 4

ANGULAR_STEPS: Final = 2
"""Presses from standing still to full strength, in ``latch``."""

_BOUNCE: Final = 0.1
"""The same key sooner than this after itself is the keyboard repeating, or a trembling hand: not a step."""

_TAP: Final = 0.15
"""How long a button counts as pressed in ``latch``, which knows no release."""


class KeyEventKind(enum.Enum):
    PRESS = enum.auto()
    REPEAT = enum.auto()
    RELEASE = enum.auto()


class DriveMode(Protocol):
    """Turns key events and time into strengths."""

    def handle(self, kind: KeyEventKind, key: str) -> None:
        """A key of the drive table, as Textual names it."""

    def advance(self) -> None:
        """Lets time pass up to the clock's now."""

    def stop(self) -> None:
        """Releases all keys."""

    def strengths(self) -> dict[str, float]:
        """Message names of the keys that count as down, and how strongly each pushes, 0 to 1."""

    def deadline(self) -> float | None:
        """When ``advance`` will next change something if no key comes; None if never."""


def _require_drive_key(key: str) -> DriveKey:
    row = drive_key(key)
    assert row is not None, f"{key} does not drive"
    return row


_CHANGES: Final[Mapping[KeyEventKind, Callable[[KeyState, str], object]]] = MappingProxyType(
    {
        KeyEventKind.PRESS: KeyState.press,
        KeyEventKind.REPEAT: KeyState.repeat,
        KeyEventKind.RELEASE: KeyState.release,
    }
)


class ExactMode:
    """The terminal reports releases: a key is down while it is down. Space lifts all others."""

    def __init__(self, clock: Clock) -> None:
        self._state = KeyState(clock)

    def handle(self, kind: KeyEventKind, key: str) -> None:
        if kind is KeyEventKind.PRESS and _require_drive_key(key).name == "space":
            self._state.clear()
        _CHANGES[kind](self._state, key)

    def advance(self) -> None:
        """Time changes nothing."""

    def stop(self) -> None:
        self._state.clear()

    def strengths(self) -> dict[str, float]:
        return {_require_drive_key(key).name: 1.0 for key in self._state.held}

    def deadline(self) -> float | None:
        return None


@dataclass(slots=True)
class _Hold:
    """A key that HoldMode takes to be down."""

    row: DriveKey
    since: float
    until: float
    """When it counts as released, unless it is heard again."""
    steady: bool = False
    """It has repeated: it is held."""
    brake: bool = False
    """It stopped its opposite, and pushes only once it repeats."""
    carried: bool = False
    """Held when another key went down: terminals repeat only the last key, so it lives as long as that one."""

    def strength(self, now: float) -> float:
        if self.steady or self.carried or not self.row.moves:
            return 1.0
        if self.brake:
            return 0.0
        return 1.0 if now - self.since < NUDGE else BRIDGE


class HoldMode:
    """No releases: a key is down while the keyboard repeats it, by timeouts learned from its rhythm.

    A press pushes at full strength for NUDGE, then at BRIDGE until the first repeat. Keys held when another
    goes down end together with it. An opposite key, or space, stops at once.
    """

    def __init__(self, clock: Clock) -> None:
        self.rhythm = Rhythm()
        self._clock = clock
        self._holds: dict[str, _Hold] = {}
        self._last_key = ""

    @property
    def _leader(self) -> str:
        """The name of the key that repeats, or would: the last one heard."""
        row = drive_key(self._last_key)
        return row.name if row else ""

    def handle(self, kind: KeyEventKind, key: str) -> None:
        row, now = _require_drive_key(key), self._clock()
        if kind is KeyEventKind.RELEASE:
            self._end(row.name)
            return
        if row.name == "space":
            self._holds = {name: hold for name, hold in self._holds.items() if name == "space"}
        if row.name != self._leader:
            for hold in self._holds.values():
                hold.carried = hold.strength(now) == 1.0
        if base_key(key) == self._last_key:
            self.rhythm.note_repeat(now)
        else:
            self.rhythm.start(now)
            self._last_key = base_key(key)
        if known := self._holds.get(row.name):
            known.steady, known.carried, known.until = True, False, now + self.rhythm.next_timeout
        else:
            against = [
                self._holds.pop(name) for name, hold in list(self._holds.items()) if row.opposes(hold.row)
            ]
            brake = any(hold.strength(now) for hold in against)
            self._holds[row.name] = _Hold(row, now, now + self.rhythm.first_timeout, brake=brake)

    def advance(self) -> None:
        now = self._clock()
        for name in [name for name, hold in self._holds.items() if not hold.carried and hold.until <= now]:
            self._end(name)

    def _end(self, name: str) -> None:
        """One key up, and with the leader those it carries."""
        self._holds.pop(name, None)
        if name == self._leader:
            self._holds = {other: hold for other, hold in self._holds.items() if not hold.carried}

    def stop(self) -> None:
        self._holds.clear()

    def strengths(self) -> dict[str, float]:
        now = self._clock()
        return {name: strength for name, hold in self._holds.items() if (strength := hold.strength(now))}

    def deadline(self) -> float | None:
        times = [hold.until for hold in self._holds.values() if not hold.carried]
        now = self._clock()
        times += [end for hold in self._holds.values() if (end := hold.since + NUDGE) > now]
        return min(times, default=None)


class LatchMode:
    """Every press adds one step; the robot keeps its speed until space, or until steps the other way undo it.

    The keys push the same way as in the other modes: S takes from the speed what W gave it.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._linear = 0
        self._angular = 0
        self._taps: dict[str, float] = {}
        self._heard: dict[str, float] = {}

    def handle(self, kind: KeyEventKind, key: str) -> None:
        if kind is not KeyEventKind.PRESS:
            return
        row, now = _require_drive_key(key), self._clock()
        last = self._heard.get(row.name)
        self._heard[row.name] = now
        if last is not None and now - last < _BOUNCE:
            return
        if row.name == "space":
            self._linear = self._angular = 0
        self._linear = max(-LINEAR_STEPS, min(LINEAR_STEPS, self._linear + row.linear))
        self._angular = max(-ANGULAR_STEPS, min(ANGULAR_STEPS, self._angular + row.angular))
        if not row.moves:
            self._taps[row.name] = now + _TAP

    def advance(self) -> None:
        now = self._clock()
        self._taps = {name: end for name, end in self._taps.items() if end > now}

    def stop(self) -> None:
        self._linear = self._angular = 0
        self._taps.clear()

    def strengths(self) -> dict[str, float]:
        pushes = {
            "up": self._linear / LINEAR_STEPS,
            "down": -self._linear / LINEAR_STEPS,
            "left": self._angular / ANGULAR_STEPS,
            "right": -self._angular / ANGULAR_STEPS,
        }
        return {name: push for name, push in pushes.items() if push > 0} | dict.fromkeys(self._taps, 1.0)

    def deadline(self) -> float | None:
        return min(self._taps.values(), default=None)
