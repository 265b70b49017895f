"""A launch without a screen: ticked until it ends by itself, or for so long, or until the user has enough."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass

from kit.launch.graph_only import Worldless
from kit.launch.launch_run import Launch
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.run.episode import EndCondition, EndReason, Tickable, run_until, when
from kit.run.lockstep import ClosableParticipant, Participant
from kit.run.pacing import MAXIMUM, REAL_TIME, Schedule


@dataclass(slots=True)
class Limit:
    """How long a launch may go on; None: as long as it likes."""

    ticks: int | None = None
    """So many ticks, of a world or without one."""
    until_s: float | None = None
    """So many simulated seconds."""

    @property
    def is_set(self) -> bool:
        return self.ticks is not None or self.until_s is not None

    def is_reached(self, now_ns: int) -> bool:
        return self.ticks == 0 or (self.until_s is not None and now_ns >= round(self.until_s * 1e9))

    def count_tick(self) -> None:
        if self.ticks is not None:
            self.ticks -= 1


def run_plainly(
    launch: Launch,
    *,
    seed: int = 0,
    limit: Limit | None = None,
    factor: float | None = None,
    company: Callable[[Graph], ClosableParticipant | None] = lambda graph: None,
    log: Callable[[LogRecord], None] = lambda record: None,
) -> None:
    """Carries the launch out in this thread: with a limit as fast as it goes, unless ``factor`` says otherwise.

    ``log`` gets what the kit's own nodes say. Raises GuestError, CannotStart, WorldError, OSError; and
    KeyboardInterrupt after the launch file has heard of it.
    """
    limit = limit or Limit()
    factor = factor or (MAXIMUM if limit.is_set else None)
    with ExitStack() as stack:
        stack.callback(launch.close)
        launch.begin()
        launch.graph.log.sink = log
        company_there: list[Participant] = []
        companion = company(launch.graph)
        if companion is not None:
            stack.callback(companion.close)
            company_there.append(companion)
        if launch.world is None:
            launch.start()
            worldless = Worldless(launch.graph)
            worldless.participants += [launch, *company_there]
            schedule = Schedule(worldless.step_size, factor=factor or REAL_TIME)
            _go_on(launch, worldless, schedule, limit, lambda: launch.world is not None or _is_idle(launch))
        if launch.world is not None and not launch.is_over:
            from kit.launch.session import LaunchedSession  # only now: it brings the physics

            session = stack.enter_context(LaunchedSession(launch, seed=seed))
            launch.graph.log.sink = log
            step_size = launch.world.step_size
            schedule = Schedule(step_size, factor=factor or launch.world.factor)
            session.runner.on_rate = lambda rate: schedule.set_factor(rate * step_size)
            session.runner.participants += company_there
            launch.start()
            _go_on(launch, session.runner, schedule, limit, lambda: False)


def _go_on(
    launch: Launch, run: Tickable, schedule: Schedule, limit: Limit, is_enough: Callable[[], bool]
) -> None:
    ends = (
        when(lambda: launch.is_over or is_enough()),
        EndCondition(EndReason.LIMIT, lambda: limit.is_reached(launch.graph.now_ns)),
    )
    try:
        run_until(run, ends=ends, schedule=schedule, before_tick=lambda number: limit.count_tick())
    except KeyboardInterrupt:
        launch.interrupt("ctrl-c")
        raise


def _is_idle(launch: Launch) -> bool:
    """Whether nothing will happen any more by itself."""
    return not (launch.has_programs or launch.wants_time)
