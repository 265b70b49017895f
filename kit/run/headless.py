"""A whole run without a face: as fast as it goes, and a summary of what came of it."""

from __future__ import annotations

import hashlib
import struct
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from kit.controllers import ControllerFile
from kit.geometry import Pose
from kit.host.failure import Failure
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.run.episode import EndCondition, EndReason, run_until, when_failed, when_reached
from kit.run.lockstep import ClosableParticipant, Observer
from kit.run.metrics import DriveMetrics
from kit.run.pacing import MAXIMUM, Schedule
from kit.run.recording import Recorder, save
from kit.run.scenario import Scenario
from kit.run.session import Session
from kit.sim.simulation import Simulation
from kit.workspace import check_writable

OUTPUT_INTERVAL = 100
"""Ticks after which the controller's output is read."""


class Fingerprint(Observer):
    """A digest of where every body was at every tick: equal for equal runs, and for no others."""

    def __init__(self) -> None:
        self._digest = hashlib.sha256()
        self.steps = 0
        """Steps made so far; resets do not restart this."""

    def on_step(self, simulation: Simulation) -> None:
        self.steps += 1
        for pose in simulation.poses():
            self._digest.update(struct.pack("<3d", *pose))

    @property
    def text(self) -> str:
        return self._digest.hexdigest()[:16]


@dataclass(frozen=True, slots=True)
class RunSummary:
    """What came of a run."""

    place: str
    controller: str
    seed: int
    ticks: int
    metrics: DriveMetrics
    pose: Pose | None
    """Where the robot ended."""
    fingerprint: str
    wall_s: float
    failure: Failure | None
    interrupted: bool = False
    """By Ctrl-C."""

    def as_dict(self) -> dict[str, Any]:
        """JSON-able; the same for the same run but for ``wall_s``."""
        return {
            "place": self.place,
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

    def text(self) -> str:
        """A few aligned lines."""
        metrics = self.metrics
        if metrics.target_m is None:
            target = "this world has none"
        elif metrics.reached_s is None:
            target = f"not reached; {metrics.target_m:.2f} m away at the end"
        else:
            target = f"reached after {metrics.reached_s:.1f} s"
        end = (
            "no robot"
            if self.pose is None
            else "x {:.3f} m, y {:.3f} m, heading {:.3f} rad".format(*self.pose)
        )
        factor = metrics.time_s / self.wall_s if self.wall_s > 0 else 0.0
        rows = [
            ("place", self.place),
            ("controller", f"{self.controller}, seed {self.seed}"),
            (
                "run",
                f"{self.ticks} steps, {metrics.time_s:.2f} s of simulated time, {factor:.0f} times real time",
            ),
            ("target", target),
            ("way", f"{metrics.distance_m:.2f} m, {metrics.bumps} bumps"),
            ("end", end),
            ("fingerprint", self.fingerprint),
        ]
        if self.failure is not None:
            rows.append(("stopped", str(self.failure).replace("\n", "\n" + " " * 13)))
        if self.interrupted:
            rows.append(("stopped", "by Ctrl-C"))
        return "\n".join(f"{name:<12} {text}" for name, text in rows)


def run_headless(
    place: Scenario,
    controller: ControllerFile,
    *,
    steps: int,
    seed: int = 0,
    factor: float = MAXIMUM,
    until_reached: bool = False,
    record: Path | None = None,
    company: Sequence[Callable[[Graph], ClosableParticipant]] = (),
    on_message: Callable[[LogRecord], object] = lambda record: None,
) -> RunSummary:
    """Runs ``steps`` ticks, fewer if the controller fails, if the target is reached and that was asked for, or
    on Ctrl-C. ``factor``: simulated seconds per second; a run that is paced waits while it is paused.

    ``on_message`` is called with what nodes log and print. Raises OSError if ``record`` cannot be written, before the run if that can be known, and what opening ``company``
    raises.
    """
    fingerprint = Fingerprint()
    if record is not None:
        check_writable(record)
    with Session(place, seed=seed, on_message=on_message) as session, ExitStack() as stack:
        runner = session.runner
        for invite in company:
            companion = invite(session.graph)
            stack.callback(companion.close)
            runner.participants.append(companion)
        runner.observers.append(fingerprint)
        recorder = (
            Recorder(place.name, place.case.name if place.case else None, runner.simulation)
            if record is not None
            else None
        )
        if recorder is not None:
            runner.observers.append(recorder)
        session.drive_with(controller)
        session.wait_until_driven()
        start = time.perf_counter()
        interrupted, is_paced = False, factor != MAXIMUM
        ends = [when_failed(session)]
        if until_reached:
            ends.append(when_reached(session.metrics))
        if is_paced:  # time spent in a pause does not count
            ends.append(EndCondition(EndReason.LIMIT, lambda: fingerprint.steps >= steps))
        try:
            run_until(
                runner,
                ticks=None if is_paced else steps,
                ends=ends,
                schedule=Schedule(runner.step_size, factor=factor) if is_paced else None,
                before_tick=lambda number: session.read_output() if number % OUTPUT_INTERVAL == 0 else None,
            )
        except KeyboardInterrupt:
            interrupted = True
        session.read_output()
        wall = time.perf_counter() - start
        if recorder is not None and record is not None:
            save(recorder.recording(), record)
        poses = dict(zip(runner.simulation.model_names, runner.simulation.poses(), strict=False))
        return RunSummary(
            place.title,
            controller.name,
            seed,
            runner.simulation.tick,
            session.metrics.metrics,
            poses.get(place.robot) if place.robot else None,
            fingerprint.text,
            wall,
            session.failure,
            interrupted,
        )
