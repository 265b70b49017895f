"""What ``topic hz``, ``delay`` and ``bw`` measure: rates, delays and bandwidth over a window of messages."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Final

RATE_WINDOW: Final = 10_000
BANDWIDTH_WINDOW: Final = 100
"""The default numbers of messages that rates and delays, and bandwidth, are taken over."""


@dataclass(frozen=True, slots=True)
class DurationStatistics:
    """Mean, extremes and standard deviation of durations [s]."""

    mean: float
    low: float
    high: float
    deviation: float
    count: int

    @classmethod
    def of(cls, durations_ns: Sequence[int]) -> DurationStatistics:
        count = len(durations_ns)
        mean = sum(durations_ns) / count
        variance = sum((duration - mean) ** 2 for duration in durations_ns) / count
        return cls(mean / 1e9, min(durations_ns) / 1e9, max(durations_ns) / 1e9, sqrt(variance) / 1e9, count)

    def __str__(self) -> str:
        return (
            f"min: {self.low:.3f}s max: {self.high:.3f}s std dev: {self.deviation:.5f}s window: {self.count}"
        )


class RateMeter:
    """Measures how often messages arrive, by the intervals between them."""

    def __init__(self, window: int = RATE_WINDOW) -> None:
        self._intervals: deque[int] = deque(maxlen=window)
        self._last_ns: int | None = None

    def add(self, now_ns: int) -> None:
        """Counts a message. Restarts if time has jumped back."""
        if self._last_ns is not None and now_ns < self._last_ns:
            self._intervals.clear()
        elif self._last_ns is not None:
            self._intervals.append(now_ns - self._last_ns)
        self._last_ns = now_ns

    def text(self) -> str | None:
        """The report; None before the second message."""
        if not self._intervals:
            return None
        statistics = DurationStatistics.of(self._intervals)
        rate = 1 / statistics.mean if statistics.mean > 0 else 0.0
        return f"average rate: {rate:.3f}\n\t{statistics}"


class DelayMeter:
    """Measures how old messages are on arrival, by the time in their header."""

    def __init__(self, window: int = RATE_WINDOW) -> None:
        self._delays: deque[int] = deque(maxlen=window)
        self._is_new = False

    def add(self, now_ns: int, stamp_ns: int) -> None:
        self._delays.append(now_ns - stamp_ns)
        self._is_new = True

    def text(self) -> str | None:
        """The report; None before the first message."""
        if not self._delays:
            return None
        if not self._is_new:
            return "no new messages"
        self._is_new = False
        statistics = DurationStatistics.of(self._delays)
        return f"average delay: {statistics.mean:.3f}\n\t{statistics}"


class BandwidthMeter:
    """Measures the bytes per second that arrive."""

    def __init__(self, window: int = BANDWIDTH_WINDOW) -> None:
        self._messages: deque[tuple[int, int]] = deque(maxlen=window)

    def add(self, now_ns: int, size: int) -> None:
        self._messages.append((now_ns, size))

    def text(self, now_ns: int) -> str | None:
        """The report; None before the second message, or if no time has passed."""
        if len(self._messages) < 2 or now_ns <= self._messages[0][0]:
            return None
        sizes = [size for _, size in self._messages]
        rate = sum(sizes) / ((now_ns - self._messages[0][0]) / 1e9)
        shown = [_bytes_text(size, rate) for size in (rate, sum(sizes) / len(sizes), min(sizes), max(sizes))]
        return (
            f"{shown[0]}/s from {len(sizes)} messages\n"
            f"\tMessage size mean: {shown[1]} min: {shown[2]} max: {shown[3]}"
        )


def _bytes_text(size: float, rate: float) -> str:
    """A number of bytes, in a unit that suits the rate."""
    if rate < 1000:
        return f"{size:.0f} B"
    return f"{size / 1000:.2f} KB" if rate < 1_000_000 else f"{size / 1_000_000:.2f} MB"
