"""Which keys are held, and how quickly a terminal repeats them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final, NamedTuple

from kit.tui.input.drive_keys import base_key

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
        """As ``first_timeout``, after a repeat."""
        return max(0.1, 2 * self.period + 4 * self.jitter + 0.02)

    def start(self, now: float) -> None:
        """Begins with a key other than the one before."""
        self._last, self._repeats, self._pause = now, 0, None

    def note_repeat(self, now: float) -> None:
        """Notes that the same key came again. A gap is understood when the next one is known: only repeats follow quickly."""
        gap, self._last = now - self._last, now
        repeating = self._repeats >= 2
        if gap > LONGEST_DELAY:
            self._repeats, self._pause = 0, None
        elif gap > (3 * self.period if repeating else SHORTEST_DELAY):
            self._repeats, self._pause = 0, (gap, repeating)
        else:
            self._update_from_gap(gap, now)

    def _update_from_gap(self, gap: float, now: float) -> None:
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
