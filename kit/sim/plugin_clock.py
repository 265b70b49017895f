"""A plugin's clock, the timer of its update rate, and its random numbers."""

from __future__ import annotations

import math
from hashlib import blake2b

from kit.kernels import kernels
from kit.msg.builtin_interfaces import Time

NEVER = 2.0**31 - 1.0
"""The period [s] of rate 0: the first update, at time 0, is the only one."""


class WorldClock:
    """Counts steps. Time is computed from the count, so that it does not drift."""

    def __init__(self, step_size: float) -> None:
        self.step_size = step_size
        """[s]"""
        self.tick = 0
        self.time_ns = 0

    def advance(self) -> None:
        """Counts a step."""
        self.tick += 1
        self.time_ns = round(self.tick * self.step_size * 1e9)

    @property
    def stamp(self) -> Time:
        """The present simulated time, as the stamp of a message."""
        time_ns = self.time_ns
        return Time(sec=time_ns // 1_000_000_000, nanosec=time_ns % 1_000_000_000)


class UpdateTimer:
    """Tells in which steps an update at a given rate is due: those that contain a multiple of its period.

    ``rate`` [Hz]: inf means every step, 0 only the very first. As in Flatland, time is compared from the middle
    of the step, so that a multiple that rounding moves a little still falls into its own step.
    """

    def __init__(self, rate: float, clock: WorldClock) -> None:
        self._clock = clock
        self._every_step = math.isinf(rate)
        self._step = clock.step_size
        self._period = 1.0 / rate if rate > 0.0 else NEVER

    def is_due(self) -> bool:
        if self._every_step:
            return True
        return math.fmod((self._clock.tick + 0.5) * self._step, self._period) < self._step


def stream_key(seed: int, *names: str) -> int:
    """A stream's key, 0 to 2**63 - 1, from the world's seed and the names of the plugin."""
    text = "\0".join([str(seed), *names])
    return int.from_bytes(blake2b(text.encode(), digest_size=8).digest(), "big") >> 1


class RandomStream:
    """Random numbers from one stream. Value ``i`` is always the same, whatever was drawn before."""

    def __init__(self, stream: int) -> None:
        self._stream = stream

    def uniform(self, index: int) -> float:
        """Returns a number in [0, 1)."""
        return float(kernels.uniform(self._stream, index))

    def normal(self, index: int, deviation: float = 1.0) -> float:
        return float(deviation * kernels.normal(self._stream, index)) if deviation else 0.0
