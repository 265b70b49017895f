"""Runs a submitted launch file in a copy of the package around it, with the package's own programs.

The launch file is the student's, and runs in a process of its own. It may start the package's programs, which are the
assignment's, in processes of their own, and no commands. Its world must be one of the package's.
"""

from __future__ import annotations

import math
import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from grader.driving.traffic import TrafficRecorder
from grader.evidence.submission_clock import SubmissionClock
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.private_folder import private_folder
from kit.host.sandbox.limits import Limits
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import printable
from kit.launch.launch_bounds import LaunchBounds
from kit.launch.launch_file_process import SHARE_FOLDER, LaunchTarget, declared_arguments
from kit.launch.launch_run import GraphOnlyRun, Launch
from kit.launch.plain_launch import LaunchSession
from kit.launch.processes import ProcessStartError
from kit.launch.requests import DeclaredArgument
from kit.msg.rcl_interfaces import GetParameters, ParameterType
from kit.plain_text import counted
from kit.render.world_text import scene_rows
from kit.ros.graph.graph import Graph
from kit.ros.graph.snapshot import GraphState, snapshot
from kit.ros.node.node import create_graph_node
from kit.ros.packages import PackageError
from kit.run.episode import run_until, when
from kit.run.recording import Recorder
from kit.run.runner import Runner
from kit.run.view import ViewBuilder
from kit.world.problems import WorldError

MAX_PROGRAMS: Final = 12
MAX_LINES: Final = 200
PID: Final = re.compile(r"\[?pid \[?\d+\]?")
ANSWER_TICKS: Final = 20
"""Ticks that a node has to answer a question about its parameters."""
MAX_STRIDE: Final = 0.1
"""A model that moves farther [m] in one tick was moved by a service."""
COLUMNS, ROWS = 60, 18
TRUTH_WORDS: Final = ("ground_truth", "get_state", "GetState")
"""What a program contains that uses the true state of the world."""


@dataclass(frozen=True, slots=True)
class LaunchCase:
    """One run of the launch file with certain arguments."""

    name: str
    time_s: float
    """Simulated."""
    arguments: Mapping[str, str]
    secret: bool = False


@dataclass(frozen=True, slots=True)
class ParameterQueries:
    """The parameters to read, by node."""

    parameters: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class LaunchRecord:
    """One finished run."""

    run: LaunchCase
    failure: Failure | None = None
    arguments: tuple[DeclaredArgument, ...] = ()
    """The arguments that the launch file declares."""
    failures: tuple[str, ...] = ()
    """What failed of what it started."""
    graph: GraphState | None = None
    """The ROS graph at the end."""
    traffic: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Nodes that published, by topic."""
    parameters: Mapping[str, str] = field(default_factory=dict)
    """``/node name`` -> its value, as text."""
    distances: Mapping[str, float] = field(default_factory=dict)
    """Distance that each model drove [m]."""
    printed: tuple[str, ...] = ()
    steps: int = 0
    drawing: str = ""
    explain_with: Any = None
    """(record, check, params) -> the sentence that ``explain`` returns."""

    @property
    def label(self) -> str:
        return "a secret launch" if self.run.secret else f"launch {self.run.name}"

    @property
    def secret(self) -> bool:
        return self.run.secret

    @property
    def outcome(self) -> str:
        if self.failure is not None:
            return f"stopped ({self.failure.kind.value})"
        return counted(len(self.nodes), "node") + (f", {len(self.failures)} failed" if self.failures else "")

    @property
    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes, without the kit's own."""
        nodes = () if self.graph is None else self.graph.nodes
        return tuple(name for name in nodes if name not in KIT_NODES)

    def explain(self, check: str, params: Any = None) -> str:
        return "" if self.explain_with is None or self.secret else str(self.explain_with(self, check, params))

    def picture(self, check: str = "") -> str:
        return self.drawing


RESERVED_NODES: Final = frozenset({"/flatland_server", "/grader_queries"})
"""Names that no program may give its nodes, also where the launch has no world."""
KIT_NODES: Final = RESERVED_NODES | {"/TeleOpKeys"}


@contextmanager
def copied_package(package: Path, file: Path) -> Iterator[LaunchTarget]:
    """Copies the package into a temporary folder, with the student's launch file in it."""
    with private_folder() as temporary:
        folder = temporary / "package"
        shutil.copytree(package, folder, ignore=shutil.ignore_patterns("__pycache__", ".*"))
        target = folder / file.name
        target.unlink(missing_ok=True)
        target.write_bytes(file.read_bytes())
        folder.chmod(0o755)  # for a program that runs as another user
        yield LaunchTarget(target, folder, (folder, SHARE_FOLDER))


def run_launch(
    run: LaunchCase,
    target: LaunchTarget,
    queries: ParameterQueries,
    *,
    level: Level,
    limits: Limits,
    clock: SubmissionClock | None = None,
) -> LaunchRecord:
    """Makes one run. A mistake of the student's becomes the record's failure."""
    clock = clock or SubmissionClock()
    limits = clock.shorten(limits)
    bounds = LaunchBounds(level, limits, limits, commands=False, max_processes=MAX_PROGRAMS)
    printed: list[str] = []
    graph = Graph(log_sink=lambda record: printed.append(f"{record.name}: {record.text}"))
    graph.reserved_names |= RESERVED_NODES
    package_files = _read_package(target.folder)
    try:
        arguments = tuple(declared_arguments(target, bounds))
        _restore_package(target.folder, package_files)
        launch = Launch(
            target,
            graph,
            arguments=run.arguments,
            bounds=bounds,
            on_output=lambda line: printed.append(str(line)),
        )
    except StudentCodeError as error:
        return LaunchRecord(run, _without_folder(clock.explain(error.failure), target))
    try:
        launch.load()
        _restore_package(target.folder, package_files)
        observed = (
            _run_with_world(run, launch, queries, clock)
            if launch.world
            else _run_without_world(run, launch, queries, clock)
        )
    except StudentCodeError as error:
        return LaunchRecord(run, _without_folder(clock.explain(error.failure), target), arguments)
    except (ProcessStartError, WorldError, PackageError, OSError) as problem:
        return LaunchRecord(
            run, _without_folder(Failure(FailureKind.EXCEPTION, str(problem)), target), arguments
        )
    finally:
        launch.close()
    return LaunchRecord(
        run,
        arguments=arguments,
        failures=tuple(printable(each) for each in launch.failures),
        printed=tuple(_normalized_line(line, target) for line in printed[:MAX_LINES]),
        **observed,
    )


def _read_package(folder: Path) -> dict[Path, tuple[int, bytes]]:
    """Returns the mode and the content of each file of a package, by its path in there."""
    return {
        file.relative_to(folder): (file.stat().st_mode & 0o777, file.read_bytes())
        for file in folder.rglob("*")
        if file.is_file()
    }


def _restore_package(folder: Path, files: Mapping[Path, tuple[int, bytes]]) -> None:
    """Undoes what a launch file has changed in its package: below level 1 nothing else keeps it from that."""
    for entry in folder.iterdir():
        if entry.is_dir() and not entry.is_symlink():
            shutil.rmtree(entry)
        else:
            entry.unlink()
    for name, (mode, content) in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
        file.chmod(mode)


def _without_folder(failure: Failure, target: LaunchTarget) -> Failure:
    """Removes the path of the temporary copy from a failure's message."""
    return replace(failure, message=printable(failure.message.replace(f"{target.folder}/", "")))


def _normalized_line(line: str, target: LaunchTarget) -> str:
    """Removes from a line what differs between runs: process ids and the path of the copy."""
    return printable(PID.sub("pid", line).replace(f"{target.folder}/", ""))


def offered_truths(target: LaunchTarget) -> frozenset[str] | None:
    """Returns which true states of the world the programs may use: all where one of the package's own names them.

    A launch file that is handed in cannot lead a program to them by a remapping otherwise.
    """
    programs = (file for file in target.folder.rglob("*.py") if file != target.file)
    is_named = any(
        word in program.read_text(errors="replace") for program in programs for word in TRUTH_WORDS
    )
    return None if is_named else frozenset()


def _run_with_world(
    run: LaunchCase, launch: Launch, queries: ParameterQueries, clock: SubmissionClock
) -> dict[str, Any]:
    assert launch.world is not None
    file = launch.world.path.resolve()
    if not file.is_relative_to(launch.target.folder.resolve()):
        raise ProcessStartError(
            f"{launch.world.where}the world must be one of the package's, not {launch.world.path}"
        )
    truths = offered_truths(launch.target)
    with LaunchSession(launch, seed=1, always_scan=True, offered_truths=truths) as session:
        sink = launch.graph.log.sink
        launch.start_processes()
        launch.graph.log.sink = sink
        recorder = Recorder(run.name, None, session.runner.simulation)
        session.runner.observers.append(recorder)
        ticks = round(run.time_s / session.runner.simulation.step_size)
        traffic_recorder = TrafficRecorder(launch.graph, session.runner.node)
        _tick_until_over(session.runner, launch, ticks, clock)
        traffic_recorder.stop()
        recording = recorder.recording()
        distances = {
            name: _driven_distance(recording.track(name)) for name in session.runner.simulation.model_names
        }
        drawn = "\n".join(
            row.rstrip() for row in scene_rows(ViewBuilder(session).build().scene, COLUMNS, ROWS)
        )
        return {
            **_graph_record(launch.graph, traffic_recorder),
            "parameters": _parameters(launch.graph, session.runner, queries),
            "distances": distances,
            "drawing": drawn,
            "steps": recording.ticks,
        }


def _run_without_world(
    run: LaunchCase, launch: Launch, queries: ParameterQueries, clock: SubmissionClock
) -> dict[str, Any]:
    launch.start_processes()
    ticker = GraphOnlyRun(launch.graph)
    ticker.participants.append(launch)
    traffic_recorder = TrafficRecorder(launch.graph, None)
    ticks = round(run.time_s / ticker.step_size)
    _tick_until_over(ticker, launch, ticks, clock)
    traffic_recorder.stop()
    return {
        **_graph_record(launch.graph, traffic_recorder),
        "parameters": _parameters(launch.graph, ticker, queries),
        "steps": ticks,
    }


def _tick_until_over(
    ticker: Runner | GraphOnlyRun, launch: Launch, ticks: int, clock: SubmissionClock
) -> None:
    """Raises StudentCodeError when the submission's time is used up."""
    run_until(ticker, ticks=ticks, ends=(clock.end_condition, when(lambda: launch.is_over)))
    clock.check()


def _graph_record(graph: Graph, traffic_recorder: TrafficRecorder) -> dict[str, Any]:
    traffic = {name: each.nodes for name, each in traffic_recorder.traffic().items()}
    return {"graph": snapshot(graph), "traffic": MappingProxyType(traffic)}


def _parameters(graph: Graph, ticker: Runner | GraphOnlyRun, queries: ParameterQueries) -> Mapping[str, str]:
    """Reads the parameters from the nodes."""
    asking_node = create_graph_node(graph, "grader_queries")
    requests = {}
    for node, names in queries.parameters.items():
        client = asking_node.create_client(GetParameters, f"{node}/get_parameters")
        if client.service_is_ready():
            requests[node] = names, client.call_async(GetParameters.Request(names=list(names)))
    run_until(ticker, ticks=ANSWER_TICKS if requests else 0)
    found = {}
    for node, (names, future) in requests.items():
        answer = future.result() if future.done() else None
        for name, value in zip(names, [] if answer is None else answer.values, strict=False):
            if value.type != ParameterType.PARAMETER_NOT_SET:
                found[f"{node} {name}"] = _parameter_text(value)
    return MappingProxyType(found)


def _parameter_text(value: Any) -> str:
    kinds = {
        ParameterType.PARAMETER_BOOL: lambda: str(value.bool_value).lower(),
        ParameterType.PARAMETER_INTEGER: lambda: str(value.integer_value),
        ParameterType.PARAMETER_DOUBLE: lambda: f"{value.double_value:g}",
        ParameterType.PARAMETER_STRING: lambda: str(value.string_value),
    }
    return printable(kinds.get(value.type, lambda: "a list")())


def _driven_distance(track: np.ndarray[Any, np.dtype[np.float64]]) -> float:
    """Returns the driven distance [m], without jumps."""
    strides = np.hypot(*np.diff(track[:, :2], axis=0).T) if len(track) > 1 else np.empty(0)
    return float(math.fsum(strides[strides <= MAX_STRIDE].tolist()))
