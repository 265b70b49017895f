"""The keys that drive, as one table, and the three ways to read driving from them: ``exact``, ``repeat`` and ``latch``."""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple, Protocol


@dataclass(frozen=True, slots=True)
class DriveKey:
    """One row: the message name, the keys that send it, how a help screen calls them, and where it pushes."""

    name: str
    keys: tuple[str, ...]
    """Textual's key names."""
    label: str
    linear: int = 0
    """+1 forward, -1 backward."""
    angular: int = 0
    """+1 left (counter-clockwise), -1 right."""

    @property
    def pressed(self) -> str:
        """The message that says it went down."""
        return f"p_{self.name}"

    @property
    def released(self) -> str:
        return f"r_{self.name}"

    @property
    def moves(self) -> bool:
        return bool(self.linear or self.angular)

    def opposes(self, other: DriveKey) -> bool:
        """Whether the two push against each other."""
        return self.linear * other.linear + self.angular * other.angular < 0


DRIVE_KEYS: Final = (
    DriveKey("up", ("up", "w"), "Up or W", linear=1),
    DriveKey("down", ("down", "s"), "Down or S", linear=-1),
    DriveKey("left", ("left", "a"), "Left or A", angular=1),
    DriveKey("right", ("right", "d"), "Right or D", angular=-1),
    DriveKey("q", ("q",), "Q"),
    DriveKey("e", ("e",), "E"),
    DriveKey("f", ("f",), "F"),
    DriveKey("space", ("space",), "Space"),
    DriveKey("shift_l", ("left_shift",), "Left Shift"),
    DriveKey("shift_r", ("right_shift",), "Right Shift"),
    DriveKey("ctrl_l", ("left_control",), "Left Ctrl"),
    DriveKey("ctrl_r", ("right_control",), "Right Ctrl"),
    DriveKey("esc", ("escape",), "Esc"),
)
"""Every key that drives. No terminal needs to be able to send the lone Shift and Ctrl: only some do."""

_BY_KEY: Final[Mapping[str, DriveKey]] = MappingProxyType(
    {key: row for row in DRIVE_KEYS for key in row.keys}
)
_BY_NAME: Final[Mapping[str, DriveKey]] = MappingProxyType({row.name: row for row in DRIVE_KEYS})


def base_key(key: str) -> str:
    """The key under a chord: ``shift+up`` is ``up``, ``W`` is ``w``. A release may carry other modifiers."""
    bare = key.rpartition("+")[2]
    return bare.lower() if len(bare) == 1 else bare


def drive_key(key: str) -> DriveKey | None:
    """The row for a key as Textual names it, alone or with Shift or Ctrl, which drive too; None if it has none."""
    *modifiers, _ = key.split("+")
    return _BY_KEY.get(base_key(key)) if {"shift", "ctrl"}.issuperset(modifiers) else None


def named(name: str) -> DriveKey:
    """The row for a message name. KeyError if there is none."""
    return _BY_NAME[name]


SHORTEST_DELAY: Final = 0.18
LONGEST_DELAY: Final = 1.1
"""A gap between these, followed by a quick one, is a delay before repeating: systems offer 0.2 to 1.02 s."""

_DELAY_WEIGHT: Final = 0.3
_PERIOD_WEIGHT: Final = 0.1
_JITTER_WEIGHT: Final = 0.05
_STUMBLE_WINDOW: Final = 5.0


class Rhythm:
    """The delay, period and jitter of the keyboard as it sounds from here: moving averages, for one session."""

    def __init__(self) -> None:
        self.delay = 0.5
        self.period = 0.06
        self.jitter = 0.01
        self.uneven = False
        """Twice within five seconds a held key was silent for so long that it counted as released: a bad link."""
        self._last = 0.0
        self._repeats = 0
        self._pause: tuple[float, bool] | None = None
        self._stumbled = -_STUMBLE_WINDOW

    @property
    def first_timeout(self) -> float:
        """How long after a press a key may be silent and still be held."""
        return 1.15 * self.delay + 0.06

    @property
    def next_timeout(self) -> float:
        """The same after a repeat."""
        return max(0.1, 2 * self.period + 4 * self.jitter + 0.02)

    def start(self, now: float) -> None:
        """Another key than before."""
        self._last, self._repeats, self._pause = now, 0, None

    def heard(self, now: float) -> None:
        """The same key again. A gap is understood when the next one is known: only repeats follow quickly."""
        gap, self._last = now - self._last, now
        repeating = self._repeats >= 2
        if gap > LONGEST_DELAY:
            self._repeats, self._pause = 0, None
        elif gap > (3 * self.period if repeating else SHORTEST_DELAY):
            self._repeats, self._pause = 0, (gap, repeating)
        else:
            self._note_repeat(gap, now)

    def _note_repeat(self, gap: float, now: float) -> None:
        self._repeats += 1
        if self._pause is not None:
            pause, was_repeating = self._pause
            self._pause = None
            self._repeats = 2
            if was_repeating:
                self._note_gap(pause, now)
            else:
                self.delay += _DELAY_WEIGHT * (pause - self.delay)
        if self._repeats >= 2:  # a single quick gap is a double tap
            self._update_period(gap)

    def _note_gap(self, pause: float, now: float) -> None:
        """A held key was silent for a while."""
        if pause > self.next_timeout:
            self.uneven |= now - self._stumbled < _STUMBLE_WINDOW
            self._stumbled = now
        self._update_period(pause)

    def _update_period(self, gap: float) -> None:
        self.jitter += _JITTER_WEIGHT * (abs(gap - self.period) - self.jitter)
        self.period += _PERIOD_WEIGHT * (gap - self.period)


class KeyTransition(NamedTuple):
    """A key went down or up at ``time`` [s] of the clock."""

    key: str
    down: bool
    time: float


class KeyState:
    """Keys by their base name, because a release carries the modifiers of its own moment, not of the press.

    ``clock`` gives seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._held: dict[str, float] = {}

    @property
    def held(self) -> Mapping[str, float]:
        """The keys that are down, longest first, and since when [s]."""
        return MappingProxyType(self._held)

    def press(self, key: str) -> tuple[KeyTransition, ...]:
        """The key goes down, unless it is down: without release events every repeat looks like a press."""
        key = base_key(key)
        if key in self._held:
            return ()
        self._held[key] = self._clock()
        return (KeyTransition(key, True, self._held[key]),)

    def repeat(self, key: str) -> tuple[KeyTransition, ...]:
        """Changes nothing. A repeat of a key that is up belongs to a press from before ``clear``."""
        return ()

    def release(self, key: str) -> tuple[KeyTransition, ...]:
        """The key goes up, if it was down."""
        key = base_key(key)
        if self._held.pop(key, None) is None:
            return ()
        return (KeyTransition(key, False, self._clock()),)

    def clear(self) -> tuple[KeyTransition, ...]:
        """All keys up: on losing the focus, on leaving the screen. Whoever releases them then, we shall not hear."""
        now = self._clock()
        up = tuple(KeyTransition(key, False, now) for key in self._held)
        self._held.clear()
        return up


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
        """Everything up, at once."""

    def strengths(self) -> dict[str, float]:
        """Message names of the keys that count as down, and how strongly each pushes, 0 to 1."""

    def deadline(self) -> float | None:
        """When ``advance`` will next change something if no key comes; None if never."""


def _row(key: str) -> DriveKey:
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
        if kind is KeyEventKind.PRESS and _row(key).name == "space":
            self._state.clear()
        _CHANGES[kind](self._state, key)

    def advance(self) -> None:
        """Time changes nothing."""

    def stop(self) -> None:
        self._state.clear()

    def strengths(self) -> dict[str, float]:
        return {_row(key).name: 1.0 for key in self._state.held}

    def deadline(self) -> float | None:
        return None


@dataclass(slots=True)
class _Hold:
    """A key that RepeatMode takes to be down."""

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


class RepeatMode:
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
        row, now = _row(key), self._clock()
        if kind is KeyEventKind.RELEASE:
            self._end(row.name)
            return
        if row.name == "space":
            self._holds = {name: hold for name, hold in self._holds.items() if name == "space"}
        if row.name != self._leader:
            for hold in self._holds.values():
                hold.carried = hold.strength(now) == 1.0
        if base_key(key) == self._last_key:
            self.rhythm.heard(now)
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
        row, now = _row(key), self._clock()
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
