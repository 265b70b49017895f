"""A charge file, graded by its potential field and by driving in it as the kit's controller ``fields`` does.

The assignment has trials, as for a controller. The file is data, read strictly; no program runs. ::

    trials:
      - {name: there, place: turn, case: turn_a_to_b, time: 60, seeds: [1], shift: [0.02, 0.02, 0.05]}
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from grader.assignment import Assignment, Trial
from grader.check import Check, NoParams, check
from grader.driving.check_table import CHECKS as DRIVE_CHECKS
from grader.driving.drive_record import GradedDrive
from grader.driving.episodes import shifted_start
from grader.evidence.contract import (
    EpisodeCollector,
    EpisodeSpec,
    Evidence,
    EvidenceCollector,
    EvidenceOptions,
    EvidenceRecord,
)
from grader.evidence.submission_clock import SubmissionClock
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.controller.kind import read_settings as read_trials
from grader.kinds.controller.sheet_keys import SHEET_KEYS
from grader.problem_text import problems_text
from grader.submitted_files import reading_submission
from kit.fields import adjacency
from kit.fields.charge_derivation import derive_charges
from kit.fields.charges import LineCharge, iter_members
from kit.fields.controller_setup import ControllerSetup
from kit.fields.layout import ChargeLayout, read_layout
from kit.fields.minima import ForceFlow
from kit.fields.trajectory import control_step
from kit.geometry import Pose
from kit.host.failure import Failure, FailureKind
from kit.msg.geometry_msgs import Twist, Vector3
from kit.plain_text import counted, format_percent
from kit.ros.graph.graph import Graph
from kit.run.episode import EndReason, run_until, when_reached
from kit.run.metrics import DriveMetrics, MetricsRecorder
from kit.run.recording import Fingerprint, Recorder, Recording
from kit.run.runner import Runner
from kit.run.scenario import Scenario
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError

STEP: Final = 0.01
"""s"""
DECISION_INTERVAL: Final = 10
"""Ticks between two decisions: the rate of the odometry."""
MAX_BYTES: Final = 64 * 1024
MAX_CHARGES: Final = 200
MAX_INTENSITY: Final = 1e6
"""The largest magnitude of an intensity."""
LEAST_WAY: Final = 0.3
"""Metres that each robot must drive, so that touching nothing means anything."""
LEAST_FACTOR: Final = 0.01
"""The least factor of the walls' intensity with which a charge counts as one."""


@dataclass(frozen=True, eq=False)
class FieldDrive(GradedDrive):
    """One drive in the student's field."""

    setup: ControllerSetup | None = None
    all_reached_s: float | None = None
    """The first time at which every robot was within the target's radius; None if never."""

    @property
    def outcome(self) -> str:
        end = f"reached after {self.all_reached_s:.1f} s" if self.all_reached_s is not None else "not reached"
        return end + (f", {counted(self.score.bumps, 'bump')}" if self.score.bumps else "")

    @cached_property
    def flow(self) -> ForceFlow:
        assert self.setup is not None
        return self.setup.flow

    @property
    def partners(self) -> Sequence[np.ndarray[Any, np.dtype[np.float64]]]:
        """(ticks, 3) of each robot."""
        return [self.recording.track(name) for name in self.scenario.partners]

    @property
    def shortest_way(self) -> float:
        """Length of the way [m] of the robot that drove least."""
        ways = [np.hypot(*np.diff(track[:, :2], axis=0).T).sum() for track in self.partners]
        return float(min(ways, default=0.0))

    def explain(self, check: str, params: Any = None) -> str:
        """Names the largest trap of the field, or the way that was hardly driven, if that explains the lost points."""
        if check == bumps.name and self.shortest_way < LEAST_WAY:
            return f"It hardly drove, {self.shortest_way:.2f} m: at least {LEAST_WAY} m are wanted, for who stands touches nothing."
        if check not in ("arrive", "free_of_traps") or self.secret:
            return ""
        trap = next(iter(self.flow.traps()), None)
        if trap is None:
            return ""
        return (
            f"There is a trap at ({round(trap.x, 2) + 0.0:.2f}, {round(trap.y, 2) + 0.0:.2f}), where walls push as strongly as the target pulls; "
            f"{format_percent(trap.share)} of the floor leads there."
        )


@dataclass(frozen=True, slots=True)
class CoverageParams:
    within: float = 0.05
    """m, of the wall's ends."""


@dataclass(frozen=True, slots=True)
class ForceParams:
    x: float = 0.0
    y: float = 0.0
    """m"""
    fx: float = 0.0
    fy: float = 0.0
    """N: what the charges should make there, the target's too."""


@check(none=3, full=0, unit="bumps")
def bumps(drive: FieldDrive, params: NoParams) -> float:
    """The robots drove and touched something: {actual} in the worst drive ({where}); {full} are allowed for all points."""
    return float(drive.score.bumps) if drive.score.bumps or drive.shortest_way >= LEAST_WAY else math.nan


@check(none=0, full=1, words=("not reached", "reached"))
def arrive(drive: FieldDrive, params: NoParams) -> float:
    """All robots reached the target in {passed} of {count} drives. Look at {where}."""
    return float(drive.all_reached_s is not None)


@check(none=60, full=40, unit="s")
def soon(drive: FieldDrive, params: NoParams) -> float:
    """The slowest drive ({where}) took {actual}; {full} earn all points."""
    return math.inf if drive.all_reached_s is None else drive.all_reached_s


@check(none=0.2, full=0.6, unit="%")
def side_by_side(drive: FieldDrive, params: NoParams) -> float:
    """The two drove side by side for {actual} of their time ({where}); {full} earns all points."""
    tracks = drive.partners
    if len(tracks) != 2 or not len(tracks[0]):
        return math.nan
    return float(
        np.mean(
            adjacency.is_adjacent_by_poses(tracks[0][::DECISION_INTERVAL], tracks[1][::DECISION_INTERVAL])
        )
    )


@check(none=0.3, full=0.01, unit="%")
def free_of_traps(drive: FieldDrive, params: NoParams) -> float:
    """From {actual} of the floor the forces do not lead to the target; {full} is allowed."""
    return float(sum(trap.share for trap in drive.flow.traps()))


@check(none=0.5, full=1, unit="%", params=CoverageParams)
def covers(drive: FieldDrive, params: CoverageParams) -> float:
    """Of the walls' length {actual} has charges that act; {full} is wanted. `kit fields show` draws them over the walls."""
    assert drive.setup is not None
    layout = drive.setup.layout
    charge_lines = _line_charges(layout.charges) if layout.intensities.walls else []
    wanted = _line_charges(derive_charges(drive.setup.grid))
    lengths = [math.dist(*each) for each in wanted]
    covered = [
        length
        for each, length in zip(wanted, lengths, strict=True)
        if any(_is_same_segment(each, other, params.within) for other in charge_lines)
    ]
    return math.fsum(covered) / math.fsum(lengths) if lengths else math.nan


@check(none=0.5, full=0.02, unit="%", params=ForceParams)
def force_at(drive: FieldDrive, params: ForceParams) -> float:
    """At one of the checked points the force is off by {actual} of what it should be."""
    assert drive.setup is not None
    setup = drive.setup
    fx, fy = (float(each) for each in setup.layout.forces((params.x, params.y), setup.target))
    return math.hypot(fx - params.fx, fy - params.fy) / max(1e-9, math.hypot(params.fx, params.fy))


Segment = tuple[tuple[float, float], tuple[float, float]]


def _line_charges(charges: Sequence[Any]) -> list[Segment]:
    """Returns the ends of all lines that act."""
    return [
        each.ends
        for each in iter_members(charges)
        if isinstance(each, LineCharge) and abs(each.intensity) >= LEAST_FACTOR
    ]


def _is_same_segment(one: Segment, other: Segment, within: float) -> bool:
    return any(
        max(math.dist(one[0], end), math.dist(one[1], start)) <= within
        for end, start in (other, (other[1], other[0]))
    )


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {
        **{name: DRIVE_CHECKS[name] for name in ("clearance", "smooth")},
        **{each.name: each for each in (bumps, arrive, soon, side_by_side, free_of_traps, covers, force_at)},
    }
)


def read_settings(files: AssignmentFiles) -> KindSettings:
    """The trials."""
    return read_trials(files)


def run_field_drive(spec: EpisodeSpec, file: Path, clock: SubmissionClock | None = None) -> FieldDrive:
    """Makes one drive to its end. Raises WorldError, LookupError or ValueError for a file that cannot be used."""
    if file.stat().st_size > MAX_BYTES:
        raise ValueError(f"{file.name} is larger than {MAX_BYTES // 1024} KiB.")
    scenario = _shifted_scenario(spec.trial, spec.seed)
    case = scenario.case
    if case is None:
        raise LookupError(f"{scenario.name} has no target.")
    setup = ControllerSetup.load(
        scenario.world.file, scenario.partners, case.target, case.target_radius, derived=True
    )
    with reading_submission(file.name, WorldError, LookupError, ValueError, OSError):
        setup = replace(setup, layout=_check_limits(read_layout(file, setup.grid)))
    simulation = Simulation(
        scenario.world, seed=spec.seed, step_size=STEP, has_subscribers=lambda topic: False
    )
    field_run = _FieldRun(scenario, setup, simulation)
    clock = clock or SubmissionClock()
    reason = field_run.run(spec.trial, clock)
    return FieldDrive(
        trial=spec.trial.name,
        label=spec.label,
        seed=spec.seed,
        secret=spec.secret,
        scenario=scenario,
        limit_s=spec.trial.time_s,
        recording=field_run.recording(),
        score=field_run.score(),
        failure=clock.used_up_failure() if reason is EndReason.STOPPED else None,
        traffic={},
        refused=(),
        printed=(),
        fingerprint=field_run.fingerprint.text,
        level=0,
        bump_ticks=() if scenario.robot is None else field_run.metrics.bump_steps(scenario.robot),
        setup=setup,
        all_reached_s=field_run.metrics.all_reached_s,
    )


def _check_limits(layout: ChargeLayout) -> ChargeLayout:
    """Raises ValueError for a layout with too many charges or too large intensities."""
    numbers = [getattr(layout.intensities, name) for name in ("walls", "target", "robot", "tension")]
    if len(layout.field.segments) > MAX_CHARGES:
        raise ValueError(f"more than {MAX_CHARGES} charges; a map has as many as it has walls and corners")
    values = [*numbers, *layout.field.segments.ravel().tolist()]
    if any(math.isnan(each) for each in values) or max(map(abs, numbers)) > MAX_INTENSITY:
        raise ValueError(f"an intensity of more than {MAX_INTENSITY:g}")
    return layout


def _shifted_scenario(trial: Trial, seed: int) -> Scenario:
    """Returns the scenario with all its robots shifted together, as the seed sets."""
    scenario, home, start = trial.scenario, trial.home(), shifted_start(trial, seed)
    moved = {
        model.name: start.compose(home.relative(model.pose))
        for model in scenario.world.models
        if model.name in scenario.partners
    }
    models = tuple(replace(each, pose=moved.get(each.name, each.pose)) for each in scenario.world.models)
    return replace(scenario, world=replace(scenario.world, models=models))


class _FieldRun:
    """The controller ``fields`` at the wheels: it decides ten times a second, and stops when something is touched."""

    def __init__(self, scenario: Scenario, setup: ControllerSetup, simulation: Simulation) -> None:
        self._scenario = scenario
        self._setup = setup
        self._simulation = simulation
        self._recorder = Recorder.for_scenario(scenario, simulation)
        self.metrics = MetricsRecorder.for_scenario(scenario)
        self.fingerprint = Fingerprint()
        self._runner = Runner(simulation, Graph(log_sink=lambda record: None))
        self._runner.observers += [self._recorder, self.metrics, self.fingerprint]

    def run(self, trial: Trial, clock: SubmissionClock) -> EndReason:
        return run_until(
            self._runner,
            limit_s=trial.time_s,
            ends=(clock.end_condition, when_reached(self.metrics)),
            before_tick=lambda number: self._decide() if number % DECISION_INTERVAL == 0 else None,
        )

    def recording(self) -> Recording:
        return self._recorder.recording()

    def score(self) -> DriveMetrics:
        """Returns the first robot's score, with the bumps of all robots."""
        return replace(self.metrics.metrics, bumps=self.metrics.total_bumps)

    def _decide(self) -> None:
        poses = [Pose(*self._simulation.pose(name)) for name in self._scenario.partners]
        has_bumped = self.metrics.total_bumps > 0
        commands = control_step(poses, self._setup.target, self._setup.layout).commands
        for robot, (forward, turn) in zip(self._setup.robots, commands, strict=True):
            is_valid = math.isfinite(forward) and math.isfinite(turn) and not has_bumped
            command = Twist(linear=Vector3(x=forward), angular=Vector3(z=turn)) if is_valid else Twist()
            self._runner.accept(robot.commands, command)


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Drives in the charge file's field when a criterion first needs that drive."""

    def run(spec: EpisodeSpec) -> Evidence:
        try:
            return run_field_drive(spec, file, options.clock)
        except (WorldError, LookupError, ValueError, OSError) as error:
            failure = Failure(FailureKind.IMPORT, problems_text(error, file.parent))
            return EvidenceRecord(failure=failure, label=spec.label, secret=spec.secret)

    return nullcontext(EpisodeCollector(assignment, options, run))


KIND: Final = SubmissionKind(
    (".yaml", ".yml"),
    CHECKS,
    read_settings,
    collect,
    sheet_keys=SHEET_KEYS,
    exercise="13-potential-fields/pair",
)
