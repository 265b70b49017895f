"""What ``topic hz``, ``bw`` and ``delay`` measure, and how they say it. Times are nanoseconds of the graph."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Final

WIDE_WINDOW: Final = 10_000
NARROW_WINDOW: Final = 100
"""Messages that count, by default, for rates and delays, and for bandwidth."""


@dataclass(frozen=True, slots=True)
class Spread:
    """Of some durations, in seconds."""

    mean: float
    low: float
    high: float
    deviation: float
    count: int

    @classmethod
    def of(cls, durations_ns: Sequence[int]) -> Spread:
        count = len(durations_ns)
        mean = sum(durations_ns) / count
        variance = sum((duration - mean) ** 2 for duration in durations_ns) / count
        return cls(mean / 1e9, min(durations_ns) / 1e9, max(durations_ns) / 1e9, sqrt(variance) / 1e9, count)

    def __str__(self) -> str:
        return (
            f"min: {self.low:.3f}s max: {self.high:.3f}s std dev: {self.deviation:.5f}s window: {self.count}"
        )


class RateMeter:
    """How often messages come: the gaps between them."""

    def __init__(self, window: int = WIDE_WINDOW) -> None:
        self._gaps: deque[int] = deque(maxlen=window)
        self._last_ns: int | None = None

    def heard(self, now_ns: int) -> None:
        """A message has come. When time has jumped back, measuring starts anew."""
        if self._last_ns is not None and now_ns < self._last_ns:
            self._gaps.clear()
        elif self._last_ns is not None:
            self._gaps.append(now_ns - self._last_ns)
        self._last_ns = now_ns

    def text(self) -> str | None:
        """None while there is nothing to say."""
        if not self._gaps:
            return None
        spread = Spread.of(self._gaps)
        rate = 1 / spread.mean if spread.mean > 0 else 0.0
        return f"average rate: {rate:.3f}\n\t{spread}"


class DelayMeter:
    """How old messages are when they come: their arrival after the time in their header."""

    def __init__(self, window: int = WIDE_WINDOW) -> None:
        self._delays: deque[int] = deque(maxlen=window)
        self._is_new = False

    def heard(self, now_ns: int, stamp_ns: int) -> None:
        self._delays.append(now_ns - stamp_ns)
        self._is_new = True

    def text(self) -> str | None:
        """None before the first message."""
        if not self._delays:
            return None
        if not self._is_new:
            return "no new messages"
        self._is_new = False
        spread = Spread.of(self._delays)
        return f"average delay: {spread.mean:.3f}\n\t{spread}"


class BandwidthMeter:
    """How many bytes come."""

    def __init__(self, window: int = NARROW_WINDOW) -> None:
        self._heard: deque[tuple[int, int]] = deque(maxlen=window)

    def heard(self, now_ns: int, size: int) -> None:
        self._heard.append((now_ns, size))

    def text(self, now_ns: int) -> str | None:
        """None before the second message, or when no time has passed."""
        if len(self._heard) < 2 or now_ns <= self._heard[0][0]:
            return None
        sizes = [size for _, size in self._heard]
        rate = sum(sizes) / ((now_ns - self._heard[0][0]) / 1e9)
        shown = [_bytes(size, rate) for size in (rate, sum(sizes) / len(sizes), min(sizes), max(sizes))]
        return (
            f"{shown[0]}/s from {len(sizes)} messages\n"
            f"\tMessage size mean: {shown[1]} min: {shown[2]} max: {shown[3]}"
        )


def _bytes(size: float, rate: float) -> str:
    """A number of bytes, in the unit that suits the rate."""
    if rate < 1000:
        return f"{size:.0f} B"
    return f"{size / 1000:.2f} KB" if rate < 1_000_000 else f"{size / 1_000_000:.2f} MB"
