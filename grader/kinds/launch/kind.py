"""A ROS 2 launch file, graded by its arguments, the nodes it starts, and what they do.

    launch:
      package: starter            # the package around the launch file, beside this file
      runs:
        - {name: usual, time: 4}
        - {name: quick, time: 4, arguments: {speed: "0.5"}}

``runs`` may be in ``secret.yaml`` too, for the grade. A check measures every run, or those that its
``with: {runs: [...]}`` names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from grader.assignment import Assignment, Criterion
from grader.check import Check, check
from grader.evidence.contract import CachingCollector, Evidence, EvidenceCollector, EvidenceOptions
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.launch.launch_record import (
    LaunchCase,
    LaunchRecord,
    ParameterQueries,
    copied_package,
    run_launch,
)
from grader.kinds.launch.sheet_keys import SHEET_KEYS
from kit.plain_files import is_file_there
from kit.plain_text import quoted
from kit.world.yaml_section import Section

QUOTES: Final = "'\""
MAX_RUN_S: Final = 60.0
"""s"""


@dataclass(frozen=True, slots=True)
class LaunchTask:
    """The package, and the runs of the launch file."""

    package: Path
    runs: tuple[LaunchCase, ...]


@dataclass(frozen=True, slots=True)
class RunParams:
    runs: tuple[str, ...] = ()
    """Names of runs; none given means all."""


@dataclass(frozen=True, slots=True)
class NodeParams:
    nodes: tuple[str, ...] = ()
    """Full names."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ArgumentParams:
    arguments: tuple[str, ...] = ()
    """Each a name, and after a space its default."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ParameterParams:
    parameters: tuple[str, ...] = ()
    """Each ``/node name value``."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class EndpointParams:
    ends: tuple[str, ...] = ()
    """Each ``/node publishes /topic`` or ``/node subscribes /topic``."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class DistanceParams:
    ways: tuple[str, ...] = ()
    """Each ``model least most``: how far it drives [m]."""
    runs: tuple[str, ...] = ()


@check(none=0, full=1, words=("something failed", "all runs"), params=RunParams)
def starts(record: LaunchRecord, params: RunParams) -> float:
    """Not everything that the launch file started ran to the end ({where})."""
    return float(not record.failures and bool(record.nodes))


@check(none=0, full=1, unit="%", params=NodeParams)
def nodes(record: LaunchRecord, params: NodeParams) -> float:
    """Of the required nodes, {actual} are there ({where})."""
    return _share_that_holds(params.nodes, lambda name: name in record.nodes)


@check(none=0, full=1, unit="%", params=ArgumentParams)
def arguments(record: LaunchRecord, params: ArgumentParams) -> float:
    """Of the required arguments, {actual} are declared as the task asks."""
    return _share_that_holds(params.arguments, lambda each: each in _declared_arguments(record))


@check(none=0, full=1, unit="%", params=ParameterParams)
def parameters(record: LaunchRecord, params: ParameterParams) -> float:
    """Of the checked parameters, {actual} have the right value ({where})."""
    return _share_that_holds(params.parameters, lambda each: _has_value(record, *each.split(maxsplit=2)))


@check(none=0, full=1, unit="%", params=EndpointParams)
def wired(record: LaunchRecord, params: EndpointParams) -> float:
    """Of the required connections, {actual} are there ({where})."""
    return _share_that_holds(params.ends, lambda each: each in _connections(record))


@check(none=0, full=1, unit="%", params=DistanceParams)
def drives(record: LaunchRecord, params: DistanceParams) -> float:
    """Of the robots, {actual} drive as far as they should ({where})."""
    return _share_that_holds(params.ways, lambda each: _is_distance_right(record, *each.split()))


def _share_that_holds(wanted: Sequence[str], holds: Callable[[str], bool]) -> float:
    return sum(map(holds, wanted)) / len(wanted) if wanted else 1.0


def _declared_arguments(record: LaunchRecord) -> list[str]:
    # ROS 2 shows a default in quotes.
    return [
        each.name if each.default is None else f"{each.name} {each.default.strip(QUOTES)}"
        for each in record.arguments
    ]


def _has_value(record: LaunchRecord, node: str, name: str, value: str) -> bool:
    declared = record.parameters.get(f"{node} {name}")
    try:
        return declared is not None and (declared == value or float(declared) == float(value))
    except ValueError:
        return False


def _connections(record: LaunchRecord) -> list[str]:
    if record.graph is None:
        return []
    return [
        f"{end.node} {verb} {topic.name}"
        for topic in record.graph.topics
        if not topic.is_infrastructure
        for verb, ends in (("publishes", topic.publishers), ("subscribes", topic.subscriptions))
        for end in ends
    ]


def _is_distance_right(record: LaunchRecord, model: str, least: str, most: str) -> bool:
    return float(least) <= record.distances.get(model, -1.0) <= float(most)


def _explain(record: LaunchRecord, name: str, params: Any) -> str:
    """Explains the first thing that is not as asked, and what is there instead."""
    return EXPLANATIONS[name](record, params)


def _explain_node(record: LaunchRecord, params: NodeParams) -> str:
    missing = next((each for each in params.nodes if each not in record.nodes), None)
    declared = ", ".join(record.nodes) or "none"
    if missing is None:
        return ""
    died = f" {record.failures[0]}" if record.failures else ""
    return f"There is no node {missing}; available: {declared}.{died}"


def _explain_argument(record: LaunchRecord, params: ArgumentParams) -> str:
    declared = _declared_arguments(record)
    missing = next((each for each in params.arguments if each not in declared), None)
    return "" if missing is None else f"Missing: {missing}. Declared: {', '.join(declared) or 'none'}."


def _explain_value(record: LaunchRecord, params: ParameterParams) -> str:
    for each in params.parameters:
        node, name, value = each.split(maxsplit=2)
        if not _has_value(record, node, name, value):
            declared = record.parameters.get(f"{node} {name}", "not there")
            return f"{name} of {node} should be {value}, and is {declared}."
    return ""


def _explain_wire(record: LaunchRecord, params: EndpointParams) -> str:
    wires = _connections(record)
    missing = next((each for each in params.ends if each not in wires), None)
    if missing is None:
        return ""
    of_node = [each for each in wires if each.startswith(missing.split()[0] + " ")]
    return f"{missing}: missing. {'; '.join(of_node) or 'That node is not there'}."


def _explain_distance(record: LaunchRecord, params: DistanceParams) -> str:
    for each in params.ways:
        model, least, most = each.split()
        if not _is_distance_right(record, model, least, most):
            distance = record.distances.get(model)
            drove = "is not in the world" if distance is None else f"drove {distance:.2f} m"
            return f"{model} {drove}; it should be {least} to {most} m."
    return ""


EXPLANATIONS: Final[Mapping[str, Callable[[LaunchRecord, Any], str]]] = MappingProxyType(
    {
        starts.name: lambda record, params: record.failures[0] if record.failures else "",
        nodes.name: _explain_node,
        arguments.name: _explain_argument,
        parameters.name: _explain_value,
        wired.name: _explain_wire,
        drives.name: _explain_distance,
    }
)


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the package and the runs."""
    section = files.public.section("launch")
    name = section.name("package", "starter")
    folder = (files.folder / name).resolve()
    if not folder.is_relative_to(files.folder.resolve()) or not is_file_there(folder / "package.xml"):
        section.error(
            f"no package {quoted(name)}: there is no {name}/package.xml beside assignment.yaml", "package"
        )
    runs = list(_read_runs(section.sections("runs", at_least=1), secret=False))
    section.finish()
    if files.secret is not None:
        runs += _read_runs(files.secret.sections("runs", ()), secret=True)
    return KindSettings(task=LaunchTask(folder, tuple(runs)))


def _read_runs(sections: Sequence[Section], *, secret: bool) -> Iterator[LaunchCase]:
    for each in sections:
        given = each.section("arguments", None)
        values = {} if given is None else {key: given.text(key) for key in given.keys()}  # noqa: SIM118 - no mapping
        if given is not None:
            given.finish()
        case = LaunchCase(
            each.name("name"),
            each.number("time", 4.0, above=0, maximum=MAX_RUN_S),
            MappingProxyType(values),
            secret,
        )
        each.finish()
        yield case


class LaunchCollector(CachingCollector):
    """Runs a launch file each time a criterion first needs that run."""

    def __init__(self, assignment: Assignment, file: Path, options: EvidenceOptions) -> None:
        super().__init__(options)
        self._assignment = assignment
        self._file = file
        self._secret = options.secret
        self._queries = ParameterQueries(_requested_parameters(assignment.criteria))

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._records(criterion, secret=self._secret)

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._records(criterion, secret=False)

    def _records(self, criterion: Criterion, *, secret: bool) -> Sequence[Evidence]:
        chosen = criterion.params.runs
        return [
            self._collect(
                (run.name, run.secret), partial(self._launch, run), LaunchRecord(run).label, secret=run.secret
            )
            for run in self._assignment.task.runs
            if (not chosen or run.name in chosen) and (secret or not run.secret)
        ]

    def _launch(self, run: LaunchCase) -> LaunchRecord:
        with copied_package(self._assignment.task.package, self._file) as target:
            record = run_launch(
                run,
                target,
                self._queries,
                level=self.level,
                limits=self._assignment.limits,
                clock=self._clock,
            )
        return replace(record, explain_with=_explain)


def _requested_parameters(criteria: Sequence[Criterion]) -> Mapping[str, tuple[str, ...]]:
    """Returns, by node, the parameters that any criterion checks."""
    found: dict[str, list[str]] = {}
    for criterion in criteria:
        if isinstance(criterion.params, ParameterParams):
            for each in criterion.params.parameters:
                node, name, _ = each.split(maxsplit=2)
                found.setdefault(node, []).append(name)
    return {node: tuple(dict.fromkeys(names)) for node, names in found.items()}


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    return nullcontext(LaunchCollector(assignment, file, options))


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (starts, nodes, arguments, parameters, wired, drives)}
)

KIND: Final = SubmissionKind(
    (".py",), CHECKS, read_settings, collect, sheet_keys=SHEET_KEYS, exercise="04-launch-files/driver"
)
