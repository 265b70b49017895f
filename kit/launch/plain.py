"""A launch without a screen: ticked until it ends by itself, or for so long, or until the user has enough."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from itertools import repeat
from typing import TYPE_CHECKING, Protocol

from kit.launch.launching import Launch
from kit.launch.worldless import Worldless
from kit.pacing import MAXIMUM, REAL_TIME, Pace
from kit.ros.graph import Graph
from kit.ros.log import LogRecord
from kit.turns import Companion, Guest

if TYPE_CHECKING:
    from kit.launch.session import LaunchedSession


class Ticker(Protocol):
    """A runner, or what stands in for it without a world."""

    guests: list[Guest]

    def tick(self) -> None: ...


def run_plainly(
    launch: Launch,
    *,
    seed: int = 0,
    ticks: int | None = None,
    until_s: float | None = None,
    factor: float | None = None,
    company: Callable[[Graph], Companion] | None = None,
    log: Callable[[LogRecord], None] = lambda record: None,
) -> None:
    """Carries the launch out in this thread. ``ticks``, ``until_s``: for so many ticks or simulated seconds, as fast
    as they go unless ``factor`` says otherwise. ``log`` gets what the kit's own nodes say.

    Raises GuestError, CannotStart, WorldError, OSError; KeyboardInterrupt after the launch file has heard of it.
    """
    with ExitStack() as stack:
        stack.callback(launch.close)
        launch.begin()
        worldless = Worldless(launch.graph)
        worldless.guests.append(launch)
        ticker: Ticker = worldless
        companion = company(launch.graph) if company is not None else None
        if companion is not None:
            stack.callback(companion.close)
            worldless.guests.append(companion)
        launch.graph.log.sink = log
        is_limited = ticks is not None or until_s is not None
        pace = Pace(worldless.step_size, factor or (MAXIMUM if is_limited else REAL_TIME))
        if launch.world is None:
            launch.start()
        try:
            for _ in repeat(None) if ticks is None else repeat(None, ticks):
                if _is_done(launch, ticker, until_s):
                    break
                if launch.world is not None and ticker is worldless:
                    from kit.launch.session import LaunchedSession  # only now: it brings the physics

                    session = stack.enter_context(LaunchedSession(launch, seed=seed))
                    launch.graph.log.sink = log
                    ticker = session.runner
                    if companion is not None:
                        ticker.guests.append(companion)
                    pace = _pace(session, MAXIMUM if is_limited and factor is None else factor)
                    launch.start()
                pace.wait()
                ticker.tick()
        except KeyboardInterrupt:
            launch.interrupt("ctrl-c")
            raise


def _pace(session: LaunchedSession, factor: float | None) -> Pace:
    wanted, runner = session.launch.world, session.runner
    assert wanted is not None
    pace = Pace(wanted.step_size, factor or wanted.factor)
    runner.on_rate = lambda rate: pace.set_factor(rate * wanted.step_size)
    return pace


def _is_done(launch: Launch, ticker: Ticker, until_s: float | None) -> bool:
    if launch.is_over or (until_s is not None and launch.graph.now_ns >= round(until_s * 1e9)):
        return True
    return (
        isinstance(ticker, Worldless)
        and launch.world is None
        and not (launch.has_programs or launch.wants_time)
    )
