"""Runs a scenario without a user interface, as fast as it goes or paced, and summarises the run."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from kit.controllers import ControllerFile, find_controller
from kit.geometry import Pose
from kit.host.failure import Failure
from kit.host.program_terminal import ProgramStreams
from kit.interruption import uninterrupted
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.run.episode import EndCondition, EndReason, run_until, when_failed, when_reached
from kit.run.lockstep import ClosableParticipant
from kit.run.metrics import DriveMetrics
from kit.run.pacing import MAXIMUM, Schedule
from kit.run.recording import Fingerprint, Recorder
from kit.run.recording_file import RecordingFile
from kit.run.scenario import Scenario, find_scenario
from kit.run.session import Session
from kit.sim.simulation import STEP_SIZE_S

OUTPUT_INTERVAL = 100
"""Ticks after which the controller's output is read."""
INPUT_INTERVAL = 5
"""The same where somebody may answer to it."""


@dataclass(frozen=True, slots=True)
class RunSummary:
    """The outcome of one run."""

    scenario: str
    """Its title."""
    controller: str
    seed: int
    ticks: int
    metrics: DriveMetrics
    pose: Pose | None
    """The robot's at the end; None without a robot."""
    fingerprint: str
    """See ``kit.run.recording.Fingerprint``."""
    wall_s: float
    """Seconds of wall clock that the run took."""
    failure: Failure | None
    interrupted: bool = False
    """Whether Ctrl-C or a signal ended it."""

    def as_dict(self) -> dict[str, Any]:
        """JSON-able; the same for the same run but for ``wall_s``."""
        return {
            "place": self.scenario,
            "controller": self.controller,
            "seed": self.seed,
            "ticks": self.ticks,
            "time_s": self.metrics.time_s,
            "distance_m": round(self.metrics.distance_m, 6),
            "bumps": self.metrics.bumps,
            "reached_s": self.metrics.reached_s,
            "target_m": self.metrics.target_m,
            "pose": None if self.pose is None else list(self.pose),
            "fingerprint": self.fingerprint,
            "wall_s": round(self.wall_s, 3),
            "failure": None if self.failure is None else str(self.failure),
            "interrupted": self.interrupted,
        }


def run_headless(
    scenario: Scenario,
    controller: ControllerFile,
    *,
    steps: int,
    seed: int = 0,
    factor: float = MAXIMUM,
    until_reached: bool = False,
    record: RecordingFile | None = None,
    participants: Sequence[Callable[[Graph], ClosableParticipant]] = (),
    on_message: Callable[[LogRecord], object] = lambda record: None,
    streams: ProgramStreams | None = None,
) -> RunSummary:
    """Runs ``steps`` ticks; fewer if the controller fails, on Ctrl-C, or with ``until_reached`` at the target.

    ``factor``: simulated seconds per second; a run that is paced waits while it is paused. ``record``: where the run is
    kept; closed at the end. ``participants``: each is opened on the run's graph and closed at its end. ``on_message``: called with
    what nodes log and print. ``streams``: what the controller reads; while it waits for that, the run goes on, in real time
    at most.

    Raises OSError if ``record`` cannot be completed, and what opening ``participants`` raises.
    """
    with (
        record or nullcontext(),
        Session(scenario, seed=seed, on_message=on_message, streams=streams) as session,
        ExitStack() as stack,
    ):
        runner, fingerprint = session.runner, Fingerprint()
        for open_participant in participants:
            participant = open_participant(session.graph)
            stack.callback(participant.close)
            runner.participants.append(participant)
        runner.observers.append(fingerprint)
        recorder = Recorder.for_scenario(scenario, runner.simulation, record)
        if record is not None:
            runner.observers.append(recorder)
        connection_watch = session.watch_connections()
        start = time.perf_counter()
        interrupted = False
        try:
            session.drive_with(controller)
            session.wait_until_driven()
            start = time.perf_counter()
            interrupted = _run_session(
                session,
                fingerprint,
                steps,
                factor,
                until_reached=until_reached,
                output_interval=OUTPUT_INTERVAL if streams is None else INPUT_INTERVAL,
            )
            session.read_output()
            connection_watch.tell_all()
            session.interrupt()
        except KeyboardInterrupt:  # before the controller drives
            interrupted = True
        finally:  # also where a terminal is gone, or Ctrl-C comes twice
            wall = time.perf_counter() - start
            if record is not None:
                with uninterrupted():
                    record.complete(recorder.recording())
        poses = dict(zip(runner.simulation.model_names, runner.simulation.poses(), strict=False))
        return RunSummary(
            scenario.title,
            controller.name,
            seed,
            runner.simulation.tick,
            session.metrics.metrics,
            poses.get(scenario.robot) if scenario.robot else None,
            fingerprint.text,
            wall,
            session.failure,
            interrupted,
        )


def _run_session(
    session: Session,
    fingerprint: Fingerprint,
    steps: int,
    factor: float,
    *,
    until_reached: bool,
    output_interval: int,
) -> bool:
    """Ticks to the end. Returns whether Ctrl-C or a signal ended it."""
    is_paced = factor != MAXIMUM
    ends = [when_failed(session)]
    if until_reached:
        ends.append(when_reached(session.metrics))
    if is_paced:  # time spent in a pause does not count
        ends.append(EndCondition(EndReason.LIMIT, lambda: fingerprint.steps >= steps))
    try:
        run_until(
            session.runner,
            ticks=None if is_paced else steps,
            ends=ends,
            schedule=Schedule(session.runner.step_size, factor=factor) if is_paced else None,
            before_tick=lambda number: session.read_output() if number % output_interval == 0 else None,
        )
    except KeyboardInterrupt:
        return True
    return False


def run_episode(
    scenario: str,
    controller: str,
    *,
    case: str | None = None,
    seconds: float = 60.0,
    seed: int = 0,
    until_reached: bool = True,
    record: Path | str | None = None,
) -> RunSummary:
    """Runs a controller in a world as fast as possible and returns the outcome.

    ``scenario``: a map's name or a world file. ``controller``: the name of one of the kit's controllers, or a ``.py``
    file. ``case``: the map's case (default: the first). ``seconds``: the longest simulated time. ``until_reached``: end
    the episode when the target is reached. ``record``: a file for the recording. The same arguments give the same run.

    Raises LookupError for an unknown map, case or controller, ValueError for a time that is none, WorldError for an invalid
    world file, and OSError if the recording cannot be written.

    >>> summary = kit.run_episode("maze", "forward", seconds=2.0)
    >>> summary.metrics.time_s, summary.failure
    (2.0, None)
    """
    if not 0.0 <= seconds < math.inf:
        raise ValueError(f"seconds must be a finite number, at least 0, not {seconds}")
    return run_headless(
        find_scenario(scenario, case),
        find_controller(controller),
        steps=round(seconds / STEP_SIZE_S),
        seed=seed,
        until_reached=until_reached,
        record=None if record is None else RecordingFile(Path(record)),
    )
