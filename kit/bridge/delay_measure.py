"""Measures by how much messages are late."""

from __future__ import annotations

from typing import Final

WINDOW_NS: Final = 5_000_000_000
"""The quickest message of the last one to two windows is what others are compared with."""


class DelayMeasure:
    """Measures by how much messages are late, each against the quickest of its sender's lately. So it does not matter by
    how much the clocks of the two machines differ, and only for a few seconds if one of them is set anew."""

    def __init__(self) -> None:
        self._quickest: dict[bytes, tuple[int, int, int]] = {}
        """By sender: when its window began, the least difference of clocks in it, and in the window before."""

    def add(self, sender: bytes, sent_ns: int, now_ns: int) -> float:
        """How late a message is [s], which was sent at ``sent_ns`` by its sender's clock."""
        offset = now_ns - sent_ns
        began, least, before = self._quickest.get(sender, (now_ns, offset, offset))
        if now_ns - began > WINDOW_NS:
            began, before, least = now_ns, least, offset
        least = min(least, offset)
        self._quickest[sender] = began, least, before
        return (offset - min(least, before)) / 1e9
