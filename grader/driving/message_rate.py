"""How often what a program publishes or prints comes, beside the rate that is asked for, and what a student is told of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from kit.plain_text import counted

LEAST_PER_SPAN: Final = 4
"""Messages or lines that a span of time should hold that is looked at by itself."""


@dataclass(frozen=True)
class MessageRate:
    """Messages or lines of an episode, beside the rate at which they should have come."""

    per_second: Mapping[int, int]
    """How many came in each second."""
    asked: float
    """How many should come in a second, above 0."""
    seconds: float
    """The episode's length, above 0."""

    @property
    def error(self) -> float:
        """How far it is off, as a share of what is asked for: over all, or the share of uneven spans, whichever is more. All at
        once is no rate."""
        return max(self.mean_error, self.uneven_share)

    @property
    def mean_error(self) -> float:
        return abs(sum(self.per_second.values()) / self.seconds - self.asked) / self.asked

    @cached_property
    def _span_s(self) -> int:
        return max(1, math.ceil(LEAST_PER_SPAN / self.asked))

    @cached_property
    def uneven_share(self) -> float:
        """The share of the time in which less than half or more than twice as much came, in spans of whole seconds. The first
        second does not count: a program begins in it."""
        length = self._span_s
        spans = [
            sum(self.per_second.get(each, 0) for each in range(first, first + length)) / (length * self.asked)
            for first in range(1, int(self.seconds) - length + 1, length)
        ]
        return sum(not 0.4 < share < 2.5 for share in spans) / len(spans) if spans else 0.0

    def describe(self, came: str) -> str:
        """Says how often it came and should have come. ``came``: what came, such as ``9 messages came on /cmd_vel``."""
        text = f"{came} in {self.seconds:.0f} s; {self.asked * self.seconds:.0f} are asked for."
        if self.uneven_share <= self.mean_error:
            return text
        span = "second" if self._span_s == 1 else counted(self._span_s, "second")
        return (
            f"{text} But they do not come evenly: in {self.uneven_share:.0%} of the time there are less than half or more than "
            f"twice as many as asked for, counted every {span}."
        )
