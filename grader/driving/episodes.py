"""Runs one episode: the world, its clock, its random numbers and the recording are the grader's, not the program's."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from grader.assignment import Shift, Trial
from grader.driving.drive_record import GradedDrive
from grader.driving.restricted_runner import RestrictedRunner
from grader.driving.service_calls import ServiceCaller
from grader.driving.traffic import MAX_PRINTED_LINES, PrintedRecorder, TrafficRecorder
from grader.evidence.contract import EpisodeSpec, EvidenceRecord
from grader.evidence.submission_clock import SubmissionClock
from kit.geometry import Pose
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.sandbox.limits import Limits
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import printable
from kit.ros.graph.connections import ConnectionsReader, NodeConnections
from kit.ros.graph.graph import Graph
from kit.run.episode import EndReason, controller_arguments, run_until, when_failed, when_reached
from kit.run.metrics import MetricsRecorder
from kit.run.recording import Fingerprint, Recorder
from kit.run.scenario import Scenario
from kit.sim.plugins.laser import LaserParams
from kit.sim.simulation import Simulation
from kit.world.records import Model, World

STEP: Final = 0.01
"""s"""
TICKS_PER_SECOND: Final = round(1 / STEP)


@dataclass(slots=True)
class ProgramLoading:
    """What the episodes so far have shown of whether a program can be loaded: one that cannot is not tried again."""

    failure: Failure | None = None
    """Why it cannot be loaded."""
    has_loaded: bool = False


LOADING_FAILURES: Final = frozenset(
    (FailureKind.SYNTAX, FailureKind.IMPORT, FailureKind.EXCEPTION, FailureKind.EXIT)
)
"""Failures before a program uses the graph that each episode would repeat."""


def run_episode(
    spec: EpisodeSpec,
    file: Path,
    *,
    limits: Limits,
    level: Level,
    clock: SubmissionClock | None = None,
    loading: ProgramLoading | None = None,
) -> GradedDrive | EvidenceRecord:
    """Runs one episode; of a program that cannot be loaded only a record of the failure is returned.

    The program is loaded before the first world is built, and beside the building of each further one. ``loading``: what
    the submission's episodes share. Raises StudentCodeError only where the machine cannot confine: that is not the
    student's.
    """
    clock, loading = clock or SubmissionClock(), loading or ProgramLoading()
    if loading.failure is not None:
        return _not_loaded(spec, loading.failure)
    scenario, home = _scenario_of_trial(spec.trial), shifted_start(spec.trial, spec.seed)
    graph = Graph(log_sink=lambda record: None)
    try:
        program = NodeProcess(
            graph,
            file,
            args=[*controller_arguments(scenario, home), *_parameter_arguments(spec.trial)],
            seed=spec.seed,
            limits=clock.shorten(limits),
            level=level,
            loads_first=True,
        )
    except StudentCodeError as error:
        return _not_loaded(spec, error.failure)
    with program:
        try:
            if not loading.has_loaded:
                program.wait_until_started()
                loading.has_loaded = True
            world = _EpisodeWorld(spec, scenario, home, graph)
            program.wait_until_started()
        except StudentCodeError as error:
            if error.failure.kind in LOADING_FAILURES:
                loading.failure = error.failure
            return _not_loaded(spec, clock.explain(error.failure), _printed_lines(program))
        return world.run(program, clock)


def _not_loaded(spec: EpisodeSpec, failure: Failure, printed: tuple[str, ...] = ()) -> EvidenceRecord:
    outcome = f"stopped ({failure.kind.value})"
    return EvidenceRecord(
        failure=failure, label=spec.label, secret=spec.secret, outcome=outcome, printed=printed
    )


class _EpisodeWorld:
    """The world of one episode, and all that watches it."""

    def __init__(self, spec: EpisodeSpec, scenario: Scenario, home: Pose, graph: Graph) -> None:
        trial = spec.trial
        self._spec = spec
        self._scenario = scenario
        simulation = Simulation(
            scenario.world,
            seed=spec.seed,
            step_size=STEP,
            has_subscribers=graph.has_subscriptions,
        )
        self._runner = RestrictedRunner(simulation, graph, trial.services, trial.topics)
        self._recorder = Recorder.for_scenario(scenario, simulation)
        self._metrics, self._fingerprint = MetricsRecorder.for_scenario(scenario), Fingerprint()
        self._runner.observers += [self._recorder, self._metrics, self._fingerprint]
        if scenario.robot is not None:
            if home != trial.home():
                self._runner.call_unrestricted("move_model", scenario.robot, tuple(home))
            self._runner.allow_home(scenario.robot, home)
        self._traffic_recorder = TrafficRecorder(graph, self._runner.node)
        self._others_topics = frozenset(
            end.topic
            for model in scenario.world.models
            if model.name not in scenario.partners
            for end in simulation.model_endpoints(model.name)
            if end.direction == "subscribe"
        ) - {
            end.topic
            for name in scenario.partners
            for end in simulation.model_endpoints(name)
            if end.direction == "subscribe"
        }
        self._service_caller = ServiceCaller(graph, trial.calls)
        self._connections_reader = ConnectionsReader(graph)

    def run(self, program: NodeProcess, clock: SubmissionClock) -> GradedDrive:
        """Ticks until the time is over, the target reached, or the program failed."""
        spec, metrics = self._spec, self._metrics
        printed = PrintedRecorder(program)
        try:
            program.enter_graph()
            program.join()
            failure, connections = self._drive(program, printed, clock)
        except StudentCodeError as error:
            failure, connections = clock.explain(error.failure), NodeConnections()
        self._traffic_recorder.stop()
        program.close()
        recording = self._recorder.recording()
        printed.take(max(0, recording.ticks - 1) // TICKS_PER_SECOND)
        traffic = self._traffic_recorder.traffic()
        # What stands in another robot's way may not be driven out of it.
        driven = [f"{name} of another robot" for name in traffic if name in self._others_topics]
        return GradedDrive(
            trial=spec.trial.name,
            label=spec.label,
            seed=spec.seed,
            secret=spec.secret,
            scenario=self._scenario,
            limit_s=spec.trial.time_s,
            recording=recording,
            score=metrics.metrics,
            failure=failure,
            traffic=traffic,
            refused=tuple([*driven, *self._runner.refused][:MAX_PRINTED_LINES]),
            printed=printed.lines,
            printed_at=printed.seconds,
            ahead=self._traffic_recorder.ahead(),
            flags=self._traffic_recorder.flags(),
            feedback_remaining=self._traffic_recorder.feedback_remaining(),
            fingerprint=self._fingerprint.text,
            level=int(program.level),
            answers=self._service_caller.answers(),
            bump_ticks=() if self._scenario.robot is None else metrics.bump_steps(self._scenario.robot),
            connections=connections,
        )

    def _drive(
        self, program: NodeProcess, printed: PrintedRecorder, clock: SubmissionClock
    ) -> tuple[Failure | None, NodeConnections]:
        def before_tick(number: int) -> None:
            self._service_caller.call_due(number * STEP)
            self._connections_reader.note()
            if number % TICKS_PER_SECOND == 0 and number:
                printed.take(number // TICKS_PER_SECOND - 1)

        self._runner.participants.append(program)
        ends = [
            clock.end_condition,
            when_failed(program),
            *([when_reached(self._metrics)] if self._spec.trial.until_reached else []),
        ]
        reason = run_until(
            self._runner,
            limit_s=self._spec.trial.time_s,
            ends=ends,
            before_tick=before_tick,
        )
        failure = clock.used_up_failure() if reason is EndReason.STOPPED else program.failure
        connections = self._connections_reader.read()
        self._runner.count_hidden_clients()
        return failure, connections


def _printed_lines(program: NodeProcess) -> tuple[str, ...]:
    """Ends the program; returns the first lines that it has printed."""
    program.close()
    lines = [printable(line.text) for line in program.take_output().lines]
    return tuple(lines[:MAX_PRINTED_LINES])


def shifted_start(trial: Trial, seed: int) -> Pose:
    """Returns the robot's start, shifted as the seed sets."""
    home, shift = trial.home(), trial.shift
    if shift == Shift():
        return home
    rng = random.Random(f"start {seed}")
    return Pose(
        home.x + rng.uniform(-shift.x, shift.x),
        home.y + rng.uniform(-shift.y, shift.y),
        home.theta + rng.uniform(-shift.theta, shift.theta),
    )


def _scenario_of_trial(trial: Trial) -> Scenario:
    scenario = trial.scenario
    if trial.noise is None and trial.laser_range is None:
        return scenario
    return replace(
        scenario, world=with_laser_settings(scenario.world, noise=trial.noise, max_range=trial.laser_range)
    )


def with_laser_settings(world: World, *, noise: float | None = None, max_range: float | None = None) -> World:
    """Returns the world with this standard deviation of every laser's noise [m] and this range [m]; None keeps it."""
    changes: dict[str, Any] = {}
    if noise is not None:
        changes["noise"] = noise
    if max_range is not None:
        changes["max_range"] = max_range
    return replace(world, models=tuple(_with_laser_settings(model, changes) for model in world.models))


def _with_laser_settings(model: Model, changes: Mapping[str, Any]) -> Model:
    plugins = tuple(
        replace(plugin, params=replace(plugin.params, **changes))
        if isinstance(plugin.params, LaserParams)
        else plugin
        for plugin in model.plugins
    )
    return replace(model, plugins=plugins)


def _parameter_arguments(trial: Trial) -> list[str]:
    words = [word for parameter in trial.parameters for word in ("-p", parameter)]
    return ["--ros-args", *words] if words else []
