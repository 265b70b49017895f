"""How many frames may be under way to the terminal: what bounds the age of the picture on a slow link.

The link's buffers, not its speed, make a picture late: whatever is written is taken, and arrives seconds
afterwards. So after each frame the terminal is asked for its cursor position, and no more frames are drawn
than so many unanswered ones.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Final

TIMEOUT: Final = 2.0
"""Seconds after which an answer is no longer waited for."""

MOST_UNDER_WAY: Final = 3

SLOW, FAST = 10, 20
"""Frames per second."""

LAG_FOR_FAST, LAG_FOR_SLOW = 0.100, 0.130
"""Below the first lag [s] the fast rate is used, above the second the slow one, between them the same as before."""

CONGESTED: Final = 0.25
"""Seconds that a picture waits in the link's buffers, beyond the link's own delay, from which on it is too much for it."""
_ENOUGH_ANSWERS: Final = 10

_SOON: Final = 1e-3
"""Seconds that make no difference: timers ring a little early or late."""
_SMOOTHING: Final = 0.2
_WINDOW: Final = 32
"""Answers over which the shortest counts as the link's own delay."""


@dataclass
class FrameThrottle:
    """Says when the next frame may be drawn. Times are seconds on any one steady clock."""

    fastest: int = FAST
    """Frames per second that are never exceeded."""

    def __post_init__(self) -> None:
        self._asked: deque[float] = deque()
        self._lags: deque[float] = deque(maxlen=_WINDOW)
        self._lag = math.nan
        self._fps = min(SLOW, self.fastest)
        self._due = -math.inf
        self._deaf = False
        """It has never answered, so it is not waited for."""

    @property
    def lag(self) -> float | None:
        """Seconds from writing a frame to the terminal's having shown it, smoothed; None if it never answered."""
        return None if math.isnan(self._lag) else self._lag

    @property
    def is_congested(self) -> bool:
        """Whether pictures wait in the link's buffers: they hold more than it carries."""
        return len(self._lags) >= _ENOUGH_ANSWERS and self._lag - min(self._lags) > CONGESTED

    @property
    def fps(self) -> int:
        return self._fps

    @property
    def allowed(self) -> int:
        """Frames that may be under way at once: as many as are shown during a round trip, and one."""
        if not self._lags:
            return 1
        return min(1 + math.ceil(min(self._lags) * self._fps), MOST_UNDER_WAY)

    def may_draw(self, now: float) -> bool:
        return self.wait(now) <= 0

    def wait(self, now: float) -> float:
        """Seconds until a frame may be drawn, if no answer arrives before."""
        self._give_up(now)
        wait = self._due - now
        if len(self._asked) >= self.allowed and not self._deaf:
            wait = max(wait, self._asked[0] + TIMEOUT - now)
        return wait if wait > _SOON else 0.0

    def _give_up(self, now: float) -> None:
        """Forgets all open questions when the oldest was put too long ago. Should they be answered after all,
        the answers are taken for later questions' until none is open: for so long the lag is underrated."""
        if self._asked and now - self._asked[0] >= TIMEOUT - _SOON:
            self._asked.clear()
            self._deaf = not self._lags

    def drawn(self, now: float) -> None:
        """A frame was drawn. One that came late does not make the next one late."""
        period = 1 / self._fps
        self._due = max(self._due + period, now + period / 2)

    def sent(self, now: float) -> None:
        """It was written, and the question after it."""
        self._asked.append(now)

    def answered(self, now: float) -> None:
        """The terminal gave its cursor position. Answers come in the order of the questions."""
        self._give_up(now)
        if not self._asked:
            return
        self._deaf = False
        lag = now - self._asked.popleft()
        self._lags.append(lag)
        self._lag = lag if math.isnan(self._lag) else self._lag + _SMOOTHING * (lag - self._lag)
        if self._lag < LAG_FOR_FAST:
            self._fps = self.fastest
        elif self._lag > LAG_FOR_SLOW:
            self._fps = min(SLOW, self.fastest)
