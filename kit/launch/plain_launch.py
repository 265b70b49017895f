"""Runs a launch without a screen, and the world that its launch file asked for, as a session."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from kit.inspection.server import InspectionServer
from kit.launch.command_time import CommandTime
from kit.launch.launch_run import GraphOnlyRun, Launch
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.run.episode import EndCondition, EndReason, run_until, when
from kit.run.lockstep import ClosableParticipant, Participant
from kit.run.pacing import MAXIMUM, REAL_TIME, Schedule
from kit.run.runner import Runner
from kit.run.scenario import scenario_in_file
from kit.run.session import Session


class LaunchSession(Session):
    """A session in whose ticks the launch takes part; closing it ends the launch. Raises WorldError, OSError."""

    def __init__(
        self,
        launch: Launch,
        *,
        seed: int = 0,
        always_scan: bool = False,
        offered_truths: frozenset[str] | None = None,
    ) -> None:
        request = launch.world
        assert request is not None, "a launch without a world"
        file = request.path.absolute()
        scenario = scenario_in_file(file, _root(file, launch.target.folder))
        super().__init__(
            replace(scenario, title=launch.target.name),
            seed=seed,
            step_size=request.step_size,
            always_scan=always_scan,
            graph=launch.graph,
            offered_truths=offered_truths,
            is_hidden=request.is_hidden,
        )
        self.launch = launch
        self.additions = launch.additions
        self.runner.participants.append(launch)

    def reset(self, seed: int | None = None) -> None:
        """Resets the world; the programs go on."""
        self.runner.call_service("reset", seed)

    def close(self) -> None:
        self.launch.close()
        super().close()


def _root(file: Path, package: Path) -> Path:
    """The folder below which the world's files may name other files: their package."""
    folders = [package, *(parent for parent in file.parents if (parent / "package.xml").is_file())]
    return next((folder for folder in folders if file.is_relative_to(folder)), file.parent)


@dataclass(slots=True)
class LaunchLimit:
    """How long a launch may run; None: without limit."""

    ticks: int | None = None
    """Ticks that are left, with or without a world."""
    until_s: float | None = None
    """Simulated time at which the launch ends [s]."""

    @property
    def is_set(self) -> bool:
        return self.ticks is not None or self.until_s is not None

    def is_reached(self, now_ns: int) -> bool:
        return self.ticks == 0 or (self.until_s is not None and now_ns >= round(self.until_s * 1e9))

    def count_tick(self) -> None:
        if self.ticks is not None:
            self.ticks -= 1


def run_plain_launch(
    launch: Launch,
    *,
    seed: int = 0,
    limit: LaunchLimit | None = None,
    factor: float | None = None,
    make_companion: Callable[[Graph], ClosableParticipant | None] = lambda graph: None,
    log: Callable[[LogRecord], None] = lambda record: None,
) -> None:
    """Runs the launch in this thread: in real time, or with a limit as fast as possible; ``factor`` overrides both.

    ``log`` receives the log lines of the kit's own nodes. Raises StudentCodeError, ProcessStartError, WorldError, OSError; and
    KeyboardInterrupt after the launch file has reacted to it.
    """
    limit = limit or LaunchLimit()
    factor = factor or (MAXIMUM if limit.is_set else None)
    with ExitStack() as stack:
        stack.callback(launch.close)
        launch.load()
        launch.graph.log.sink = log
        companions: list[Participant] = []
        companion = make_companion(launch.graph)
        command_time = None
        if factor == MAXIMUM:
            clients = companion.owed_answers if isinstance(companion, InspectionServer) else dict
            command_time = CommandTime(launch, clients)
            launch.delays_command_ends = True
        if companion is not None:
            stack.callback(companion.close)
            companions.append(companion)
        if launch.world is None:
            launch.start_processes()
            graph_only_run = GraphOnlyRun(launch.graph)
            graph_only_run.participants += [launch, *companions]
            schedule = Schedule(graph_only_run.step_size, factor=factor or REAL_TIME)
            _run_until_end(
                launch,
                graph_only_run,
                schedule,
                limit,
                lambda: launch.world is not None or _is_idle(launch),
                command_time,
            )
        if launch.world is not None and not launch.is_over:
            session = stack.enter_context(LaunchSession(launch, seed=seed))
            launch.graph.log.sink = log
            step_size = launch.world.step_size
            schedule = Schedule(step_size, factor=factor or launch.world.factor)
            session.runner.on_rate = lambda rate: schedule.set_factor(rate * step_size)
            session.runner.participants += companions
            launch.start_processes()
            _run_until_end(launch, session.runner, schedule, limit, lambda: False, command_time)


def _run_until_end(
    launch: Launch,
    run: Runner | GraphOnlyRun,
    schedule: Schedule,
    limit: LaunchLimit,
    is_done: Callable[[], bool],
    command_time: CommandTime | None,
) -> None:
    """``command_time``: None where the run is paced."""

    def before_tick(number: int) -> None:
        if command_time is not None:
            command_time.wait(run.exchange_until_idle)
        limit.count_tick()

    ends = (
        when(lambda: launch.is_over or is_done()),
        EndCondition(EndReason.LIMIT, lambda: limit.is_reached(launch.graph.now_ns)),
    )
    try:
        run_until(run, ends=ends, schedule=schedule, before_tick=before_tick)
        launch.tell_unconnected()
    except KeyboardInterrupt:
        launch.interrupt("ctrl-c")
        raise


def _is_idle(launch: Launch) -> bool:
    """True if no process and no timer is left."""
    return not (launch.has_programs or launch.has_timers)
