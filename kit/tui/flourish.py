"""The flourish of a new medal: about a second of numbered pictures, which any key ends, and which reduced motion leaves out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from textual.screen import Screen
from textual.timer import Timer

from kit.tui.rows.medal_rows import SPARKS
from kit.tui.theme import Theme

SPARK_INTERVAL: Final = 0.1
"""Between two pictures [s]."""


class Flourish:
    """Counts the pictures down on a screen, which shows itself anew at each."""

    def __init__(self, theme: Theme, show: Callable[[], object]) -> None:
        self._is_still = theme.terminal.reduce_motion.value
        self._show = show
        self._timer: Timer | None = None
        self.number = 0
        """Of the picture that is shown; 0 for none."""

    def begin(self, screen: Screen[Any]) -> None:
        if not self._is_still:
            self.end()
            self.number = SPARKS
            self._timer = screen.set_interval(SPARK_INTERVAL, self._show_next)

    def end(self) -> None:
        """Nothing is shown of it any more; the screen is to be shown anew."""
        self.number = 0
        if self._timer is not None:
            self._timer.stop()

    def _show_next(self) -> None:
        self.number -= 1
        if self.number <= 0:
            self.end()
        self._show()
