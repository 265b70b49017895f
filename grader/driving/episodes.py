"""Runs one episode: the world, its clock, its random numbers and the recording are the grader's, not the program's."""

from __future__ import annotations

import math
import random
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from grader.assignment import Shift, Trial
from grader.driving.drive_record import GradedDrive, TopicTraffic
from grader.driving.service_calls import ServiceCaller
from grader.evidence.contract import EpisodeSpec, EvidenceRecord
from grader.evidence.submission_clock import SubmissionClock
from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.sandbox.confinement import Level
from kit.host.sandbox.limits import Limits
from kit.host.wire import printable
from kit.msg.message import Message, type_name
from kit.msg.robot_kit_msgs import GetState
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Bool
from kit.ros.graph.connections import ConnectionsReader, NodeConnections
from kit.ros.graph.directory import GraphNode
from kit.ros.graph.graph import Graph
from kit.run.episode import EndReason, controller_arguments, run_until, when_failed, when_reached
from kit.run.metrics import MetricsRecorder
from kit.run.recording import Fingerprint, Recorder
from kit.run.runner import GET_STATE_SERVICE, Runner
from kit.run.scenario import Scenario
from kit.sim.plugins.laser import LaserParams
from kit.sim.simulation import Simulation, SimulationError
from kit.world.records import Model, World

STEP: Final = 0.01
"""s"""
TICKS_PER_SECOND: Final = round(1 / STEP)

GET_STATE: Final = GET_STATE_SERVICE.removeprefix("/")
"""The service that tells the true state of the world, as an assignment names it."""

HOME_TOLERANCE: Final = 1e-6
"""A robot may be moved to within this distance of its home [m, rad], and nowhere else."""

MAX_PRINTED_LINES: Final = 200
"""Lines of a program's output that are kept."""


class RestrictedRunner(Runner):
    """A runner whose world services are restricted by the assignment, and whose clock no program can pause.

    The true state of the world is not offered, unless the assignment names its topic or its service.
    """

    def __init__(
        self,
        simulation: Simulation,
        graph: Graph,
        services: frozenset[str],
        topics: frozenset[str] = frozenset(),
    ) -> None:
        self._services = services
        self._home: tuple[str | None, Pose] = (None, Pose())
        self.refused: list[str] = []
        super().__init__(simulation, graph, offered_truths=topics | (services & {GET_STATE}))

    def count_hidden_clients(self) -> None:
        """Counts clients of the service for the true state of the world, which is not offered, as refused."""
        if not self.offers_truth(GET_STATE_SERVICE):
            self.refused += [
                GET_STATE
                for node in self.graph.directory.nodes
                for client in node.clients
                if client.service_name == GET_STATE_SERVICE and client.srv_type is GetState
            ]

    def allow_home(self, robot: str | None, home: Pose) -> None:
        """Sets the robot and the home it may be moved to."""
        self._home = robot, home

    def call_service(self, service: str, *arguments: Any) -> None:
        if not self._is_allowed(service, arguments):
            self.refused.append(service)
            raise SimulationError(f"{service} is not allowed while a program is graded")
        super().call_service(service, *arguments)

    def call_unrestricted(self, service: str, *arguments: Any) -> None:
        """Calls a service without the restrictions, for the grader itself."""
        super().call_service(service, *arguments)

    @property
    def paused(self) -> bool:
        return False

    @paused.setter
    def paused(self, value: bool) -> None:
        if value:
            self.refused.append("pause")

    def _is_allowed(self, service: str, arguments: tuple[Any, ...]) -> bool:
        if service not in self._services:
            return False
        if service != "move_model":
            return True
        robot, home = self._home
        name, pose = arguments
        return name == robot and all(
            abs(wanted - allowed) <= HOME_TOLERANCE for wanted, allowed in zip(pose, home, strict=True)
        )


class TrafficRecorder:
    """Counts the messages on each topic that nodes other than the world's own publish, second by second, and notes what the
    lasers of the world measured ahead, what the program's booleans said and how much it told was left."""

    def __init__(self, graph: Graph, world_node: GraphNode | None) -> None:
        self._world_node = world_node
        self._counts: dict[tuple[str, str], Counter[int]] = {}
        self._nodes: dict[tuple[str, str], set[str]] = {}
        self._ahead: dict[str, list[tuple[float, float, float]]] = {}
        self._flags: dict[str, dict[int, bool]] = {}
        self._remaining: dict[str, dict[int, float]] = {}
        self.stop = graph.add_message_listener(self._on_message)

    def _on_message(self, time_ns: int, node: GraphNode, name: str, message: Message) -> None:
        if node is self._world_node:
            if isinstance(message, LaserScan) and message.ranges:
                self._ahead.setdefault(name, []).append((time_ns / 1e9, *_ranges_ahead(message)))
            return
        if isinstance(message, Bool):
            self._flags.setdefault(name, {})[time_ns] = bool(message.data)
        remaining = getattr(getattr(message, "feedback", None), "remaining", None)
        if isinstance(remaining, float):
            self._remaining.setdefault(name, {})[time_ns] = remaining
        key = name, type_name(type(message))
        self._counts.setdefault(key, Counter())[time_ns // 10**9] += 1
        self._nodes.setdefault(key, set()).add(node.handle.full_name)

    def traffic(self) -> Mapping[str, TopicTraffic]:
        return {
            name: TopicTraffic(kind, counts.total(), tuple(sorted(self._nodes[name, kind])), counts)
            for (name, kind), counts in sorted(self._counts.items(), key=lambda each: each[0])
        }

    def ahead(self) -> Mapping[str, FloatArray]:
        """Returns (k, 3) for each laser's topic; see ``GradedDrive``."""
        return {name: np.array(rows, dtype=np.float64) for name, rows in self._ahead.items()}

    def flags(self) -> Mapping[str, FloatArray]:
        """Returns (k, 2) for each topic of booleans; see ``GradedDrive``."""
        return _by_time(self._flags)

    def remaining(self) -> Mapping[str, FloatArray]:
        """Returns (k, 2) for each topic of an action's feedback; see ``GradedDrive``."""
        return _by_time(self._remaining)


def _by_time(values: Mapping[str, Mapping[int, float]]) -> Mapping[str, FloatArray]:
    return {
        name: np.array([(time_ns / 1e9, value) for time_ns, value in said.items()], dtype=np.float64)
        for name, said in values.items()
    }


AHEAD: Final = math.radians(60)
"""What a scan sees within this angle to either side of its middle may be called ahead [rad]."""


def _ranges_ahead(scan: LaserScan) -> tuple[float, float]:
    """Returns the range of the ray in the middle, and the nearest of those within ``AHEAD`` of it [m]; nan for none."""
    middle, count = len(scan.ranges) // 2, round(AHEAD / abs(scan.angle_increment or math.inf))
    near = [each for each in scan.ranges[max(0, middle - count) : middle + count + 1] if each == each]
    return float(scan.ranges[middle]), float(min(near, default=math.nan))


class PrintedRecorder:
    """Takes what a program prints second by second, since its lines carry no time of their own."""

    def __init__(self, program: NodeProcess) -> None:
        self._program = program
        self._lines: list[str] = []
        self._seconds: list[int] = []

    def take(self, second: int) -> None:
        """Takes what was printed since the last call; of all that, the first lines are kept."""
        for line in self._program.take_output().lines[: MAX_PRINTED_LINES - len(self._lines)]:
            self._lines.append(printable(line.text))
            self._seconds.append(second)

    @property
    def lines(self) -> tuple[str, ...]:
        return tuple(self._lines)

    @property
    def seconds(self) -> tuple[int, ...]:
        """The second of the episode in which each line was printed."""
        return tuple(self._seconds)


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
    scenario, home = _scenario(spec.trial), shifted_start(spec.trial, spec.seed)
    graph = Graph(log_sink=lambda record: None)
    try:
        program = NodeProcess(
            graph,
            file,
            args=[*controller_arguments(scenario, home), *_parameters(spec.trial)],
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
            remaining=self._traffic_recorder.remaining(),
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


def _scenario(trial: Trial) -> Scenario:
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


def _parameters(trial: Trial) -> list[str]:
    words = [word for parameter in trial.parameters for word in ("-p", parameter)]
    return ["--ros-args", *words] if words else []
