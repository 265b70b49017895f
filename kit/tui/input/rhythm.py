"""How this keyboard repeats a held key, learned from when its events arrive.

A terminal without release events shows a held key as: a press, the delay, then repeats, one period apart.
All times in seconds.
"""

from __future__ import annotations

from typing import Final

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
