"""How fast a run goes: asked for, due, and reached."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Final

REAL_TIME: Final = 1.0
MAXIMUM: Final = float("inf")
"""As fast as it goes."""

CATCH_UP: Final = 0.25
"""How far [s] a run may fall behind the wall clock before it gives up catching up, rather than jump."""


@dataclass(frozen=True, slots=True)
class Pacing:
    """How a run goes at the moment."""

    factor: float
    """Asked for: simulated seconds per second; ``inf`` is as fast as it goes."""
    reached: float
    """Really reached, over the last second or so."""
    paused: bool


class Schedule:
    """When ticks are due: ``factor`` simulated seconds per wall second, catching up a little but never a lot."""

    def __init__(self, step: float, now: float) -> None:
        self._step = step
        self._factor = REAL_TIME
        self._next = now

    def set_factor(self, factor: float) -> None:
        self._factor = factor

    def restart(self, now: float) -> None:
        self._next = now + self._step / self._factor

    def wait_for_next(self, now: float) -> float:
        """Seconds until the next tick is due, 0 when one is."""
        return 0.0 if self._factor == MAXIMUM else max(0.0, self._next - now)

    def due(self, now: float) -> bool:
        if self._factor == MAXIMUM:
            self._next = now
            return True
        if now - self._next > CATCH_UP:
            self._next = now
        return now >= self._next

    def ticked(self) -> None:
        self._next += self._step / self._factor


class Pace:
    """The same for whoever ticks in a loop of its own: ``wait`` before each tick."""

    def __init__(self, step: float, factor: float = REAL_TIME) -> None:
        self._schedule = Schedule(step, time.monotonic())
        self._schedule.set_factor(factor)

    def set_factor(self, factor: float) -> None:
        self._schedule.set_factor(factor)

    def wait(self) -> None:
        """Until the next tick is due."""
        while not self._schedule.due(now := time.monotonic()):
            time.sleep(self._schedule.wait_for_next(now))
        self._schedule.ticked()


class Meter:
    """The speed really reached: simulated over wall seconds, over the last one to two seconds."""

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
