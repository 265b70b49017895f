"""Mends a fault of Textual's: a timer that should fire once never fires where its task starts later than its interval."""

from __future__ import annotations

from typing import Any

import textual
import textual.message_pump
from textual.timer import Timer


class OneShotTimer(Timer):
    """A timer that leaves out no call if it fires a limited number of times.

    Textual's leaves out the calls whose time has passed when its task gets to run. Of a timer that fires once there is no
    other: on a busy machine the app then keeps a size that the terminal no longer has, and a picture stands still.
    """

    def __init__(self, *args: Any, repeat: int | None = None, skip: bool = True, **options: Any) -> None:
        super().__init__(*args, repeat=repeat, skip=skip and repeat is None, **options)


def fire_late_timers() -> None:
    """Makes ``set_timer`` call back even if it is late, in widgets, screens and apps, Textual's own calls among them."""
    setattr(textual.message_pump, "Timer", OneShotTimer)  # noqa: B010  # mypy takes no assignment to a class's name
