"""The one way that tests wait: for a state, with a limit that no working machine reaches."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from textual.pilot import Pilot

LIMIT_S = 60.0
"""A machine beside other work has stood still for twenty seconds."""


def wait_until(
    condition: Callable[[], object],
    what: str | Callable[[], str] = "the condition",
    *,
    every_s: float = 0.002,
    limit_s: float = LIMIT_S,
) -> None:
    """Returns when ``condition`` is true; fails, naming ``what`` was awaited, after ``limit_s``."""
    end = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < end, f"waited in vain for {what if isinstance(what, str) else what()}"
        time.sleep(every_s)


async def wait_until_shown(
    pilot: Pilot[None],
    condition: Callable[[], object],
    what: str | Callable[[], str] = "the condition",
    *,
    limit_s: float = LIMIT_S,
) -> None:
    """The same for a Textual app under a pilot, whose event loop goes on meanwhile."""
    try:
        async with asyncio.timeout(limit_s):
            while not condition():
                await pilot.pause(0.02)
    except TimeoutError:
        raise AssertionError(f"waited in vain for {what if isinstance(what, str) else what()}") from None
