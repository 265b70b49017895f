"""Pacing: the speed that a run is asked to have, when its ticks are due, and the speed it really has."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Final

REAL_TIME: Final = 1.0
MAXIMUM: Final = float("inf")
"""Simulated seconds per second of a run that goes as fast as it can."""

MAX_LAG_S: Final = 0.25
"""A run that is farther [s] behind the wall clock gives up catching up rather than jump."""


@dataclass(frozen=True, slots=True)
class PacingStatus:
    """A run's speed at one instant."""

    factor: float
    """The speed asked for: simulated seconds per second; ``inf``: as fast as it can."""
    actual_factor: float
    """Measured over the last second or so."""
    paused: bool


class Schedule:
    """When ticks are due: ``factor`` simulated seconds per wall second, catching up a little but never a lot.

    A loop that only ticks calls ``wait`` before each tick; one that has more to do asks ``is_due`` and calls
    ``count_tick`` after each. ``now``: monotonic time [s], by default that of the call.
    """

    def __init__(self, step_size: float, now: float | None = None, *, factor: float = REAL_TIME) -> None:
        self._step_size = step_size
        self._factor = factor
        self._next = time.monotonic() if now is None else now

    def set_factor(self, factor: float) -> None:
        """Changes the simulated seconds per wall second; ``inf``: every tick is due at once."""
        self._factor = factor

    def wait(self) -> None:
        """Sleeps until the next tick is due, and counts it."""
        while not self.is_due(now := time.monotonic()):
            time.sleep(self.seconds_until_next(now))
        self.count_tick()

    def restart(self, now: float) -> None:
        """Forgets what is overdue: the next tick is due one step from ``now``."""
        self._next = now + self._step_size / self._factor

    def seconds_until_next(self, now: float) -> float:
        """0 when a tick is due."""
        return 0.0 if self._factor == MAXIMUM else max(0.0, self._next - now)

    def is_due(self, now: float) -> bool:
        """Whether the next tick should be made by ``now``."""
        if self._factor == MAXIMUM:
            self._next = now
            return True
        if now - self._next > MAX_LAG_S:
            self._next = now
        return now >= self._next

    def count_tick(self) -> None:
        """The next tick is due one step later."""
        self._next += self._step_size / self._factor


class SpeedMeter:
    """Measures a run's speed: simulated over wall seconds, over the last one to two seconds."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        self._old: tuple[float, float] | None = None
        self._start: tuple[float, float] | None = None
        self._simulated = 0.0
        self.factor = 0.0

    def add(self, simulated: float, now: float) -> None:
        if self._start is None:
            self._start = (now, 0.0)
        self._simulated += simulated
        if now - self._start[0] >= 1.0:
            self._old, self._start = self._start, (now, self._simulated)
        since = self._old or self._start
        if now > since[0]:
            self.factor = (self._simulated - since[1]) / (now - since[0])
