"""A ROS 2 launch file: what it declares, who is there when it has been carried out, and what they do.

    launch:
      package: starter            # the package around the launch file, beside this sheet
      runs:
        - {name: usual, time: 4}
        - {name: quick, time: 4, arguments: {speed: "0.5"}}

``runs`` may stand in ``secret.yaml`` too: those are for the grade. A check looks at every run, or at those that its
``with: {runs: [...]}`` names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from grader.assignment import Assignment, Criterion
from grader.checks.contract import Check, check
from grader.evidence.launch import Launched, Questions, Run, laid_out, launched
from grader.kinds.contract import Conditions, Sheet, Sort, Task
from kit.host.failure import FailureKind
from kit.host.sandbox.confinement import Level
from kit.world.problems import quoted
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from grader.grading import Gatherer

QUOTES: Final = "'\""
LONGEST_RUN: Final = 60.0
"""s"""


@dataclass(frozen=True, slots=True)
class Launches:
    """The kind's task."""

    package: Path
    runs: tuple[Run, ...]


@dataclass(frozen=True, slots=True)
class Runs:
    runs: tuple[str, ...] = ()
    """Which; none: all."""


@dataclass(frozen=True, slots=True)
class Nodes:
    nodes: tuple[str, ...] = ()
    """Full names."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Arguments:
    arguments: tuple[str, ...] = ()
    """Each a name, and after a space its default."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Parameters:
    parameters: tuple[str, ...] = ()
    """Each ``/node name value``."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Ends:
    ends: tuple[str, ...] = ()
    """Each ``/node publishes /topic`` or ``/node subscribes /topic``."""
    runs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Ways:
    ways: tuple[str, ...] = ()
    """Each ``model least most``: how far it drives [m]."""
    runs: tuple[str, ...] = ()


@check(none=0, full=1, words=("something failed", "all runs"), params=Runs)
def starts(seen: Launched, params: Runs) -> float:
    """Not everything that the launch file started ran to the end ({where})."""
    return float(not seen.died and bool(seen.nodes))


@check(none=0, full=1, unit="%", params=Nodes)
def nodes(seen: Launched, params: Nodes) -> float:
    """Of the nodes that were asked for, {actual} are there ({where})."""
    return _share(params.nodes, lambda name: name in seen.nodes)


@check(none=0, full=1, unit="%", params=Arguments)
def arguments(seen: Launched, params: Arguments) -> float:
    """Of the arguments that were asked for, {actual} are declared as asked."""
    return _share(params.arguments, lambda each: each in _declared(seen))


@check(none=0, full=1, unit="%", params=Parameters)
def parameters(seen: Launched, params: Parameters) -> float:
    """Of the parameters that were looked at, {actual} have the value they should have ({where})."""
    return _share(params.parameters, lambda each: _has(seen, *each.split(maxsplit=2)))


@check(none=0, full=1, unit="%", params=Ends)
def wired(seen: Launched, params: Ends) -> float:
    """Of the wires that were asked for, {actual} are there ({where})."""
    return _share(params.ends, lambda each: each in _wires(seen))


@check(none=0, full=1, unit="%", params=Ways)
def drives(seen: Launched, params: Ways) -> float:
    """Of the robots, {actual} drive as far as they should ({where})."""
    return _share(params.ways, lambda each: _drove(seen, *each.split()))


def _share(wanted: Sequence[str], holds: Callable[[str], bool]) -> float:
    return sum(map(holds, wanted)) / len(wanted) if wanted else 1.0


def _declared(seen: Launched) -> list[str]:
    # A default is told as ROS 2 shows it: in quotes.
    return [
        each.name if each.default is None else f"{each.name} {each.default.strip(QUOTES)}"
        for each in seen.arguments
    ]


def _has(seen: Launched, node: str, name: str, value: str) -> bool:
    there = seen.parameters.get(f"{node} {name}")
    try:
        return there is not None and (there == value or float(there) == float(value))
    except ValueError:
        return False


def _wires(seen: Launched) -> list[str]:
    if seen.graph is None:
        return []
    return [
        f"{end.node} {verb} {topic.name}"
        for topic in seen.graph.topics
        if not topic.is_infrastructure
        for verb, ends in (("publishes", topic.publishers), ("subscribes", topic.subscriptions))
        for end in ends
    ]


def _drove(seen: Launched, model: str, least: str, most: str) -> bool:
    return float(least) <= seen.ways.get(model, -1.0) <= float(most)


def _remark(seen: Launched, name: str, params: Any) -> str:
    """The first thing that is not as asked, and what is there instead."""
    return REMARKS[name](seen, params)


def _missing_node(seen: Launched, params: Nodes) -> str:
    missing = next((each for each in params.nodes if each not in seen.nodes), None)
    there = ", ".join(seen.nodes) or "none"
    if missing is None:
        return ""
    died = f" {seen.died[0]}" if seen.died else ""
    return f"There is no node {missing}; there are: {there}.{died}"


def _missing_argument(seen: Launched, params: Arguments) -> str:
    there = _declared(seen)
    missing = next((each for each in params.arguments if each not in there), None)
    return "" if missing is None else f"Missing: {missing}. Declared: {', '.join(there) or 'none'}."


def _other_value(seen: Launched, params: Parameters) -> str:
    for each in params.parameters:
        node, name, value = each.split(maxsplit=2)
        if not _has(seen, node, name, value):
            there = seen.parameters.get(f"{node} {name}", "not there")
            return f"{name} of {node} should be {value}, and is {there}."
    return ""


def _missing_wire(seen: Launched, params: Ends) -> str:
    wires = _wires(seen)
    missing = next((each for each in params.ends if each not in wires), None)
    if missing is None:
        return ""
    of_node = [each for each in wires if each.startswith(missing.split()[0] + " ")]
    return f"{missing}: not so. {'; '.join(of_node) or 'That node is not there'}."


def _other_way(seen: Launched, params: Ways) -> str:
    for each in params.ways:
        model, least, most = each.split()
        if not _drove(seen, model, least, most):
            way = seen.ways.get(model)
            drove = "is not in the world" if way is None else f"drove {way:.2f} m"
            return f"{model} {drove}; it should be {least} to {most} m."
    return ""


REMARKS: Final[Mapping[str, Callable[[Launched, Any], str]]] = MappingProxyType(
    {
        starts.name: lambda seen, params: seen.died[0] if seen.died else "",
        nodes.name: _missing_node,
        arguments.name: _missing_argument,
        parameters.name: _other_value,
        wired.name: _missing_wire,
        drives.name: _other_way,
    }
)


def read(sheet: Sheet) -> Task:
    """The package, and how the launch file is launched."""
    section = sheet.public.section("launch")
    name = section.name("package", "starter")
    folder = (sheet.folder / name).resolve()
    if not folder.is_relative_to(sheet.folder.resolve()) or not (folder / "package.xml").is_file():
        section.error(
            f"no package {quoted(name)}: there is no {name}/package.xml beside the sheet", "package"
        )
    runs = list(_runs(section.sections("runs", at_least=1), secret=False))
    section.finish()
    if sheet.secret is not None:
        runs += _runs(sheet.secret.sections("runs", ()), secret=True)
    return Task(content=Launches(folder, tuple(runs)))


def _runs(sections: Sequence[Section], *, secret: bool) -> Iterator[Run]:
    for each in sections:
        given = each.section("arguments", None)
        values = {} if given is None else {key: given.text(key) for key in given.keys()}  # noqa: SIM118 - no mapping
        if given is not None:
            given.finish()
        made = Run(
            each.name("name"),
            each.number("time", 4.0, above=0, maximum=LONGEST_RUN),
            MappingProxyType(values),
            secret,
        )
        each.finish()
        yield made


class _Gathered:
    """The runs of one launch file, each when a criterion first needs it."""

    def __init__(self, assignment: Assignment, file: Path, conditions: Conditions) -> None:
        self.level = conditions.level
        self._assignment = assignment
        self._file = file
        self._secret = conditions.secret
        self._may_fall = conditions.may_fall and not conditions.secret
        self._seen: dict[tuple[str, bool], Launched] = {}
        self._questions = Questions(_asked(assignment.criteria))

    def evidence(self, criterion: Criterion) -> Sequence[Launched]:
        chosen = criterion.params.runs
        return [
            self._run(run)
            for run in self._assignment.task.runs
            if (not chosen or run.name in chosen) and (self._secret or not run.secret)
        ]

    def all(self) -> Sequence[Launched]:
        return list(self._seen.values())

    def _run(self, run: Run) -> Launched:
        key = run.name, run.secret
        while key not in self._seen:
            with laid_out(self._assignment.task.package, self._file) as target:
                seen = launched(
                    run, target, self._questions, level=self.level, limits=self._assignment.limits
                )
            cannot = seen.failure is not None and seen.failure.kind is FailureKind.CONFINEMENT
            if cannot and self._may_fall and self.level > Level.LIMITED:
                self.level = Level(self.level - 1)
                continue
            seen = replace(seen, remarks=_remark)
            self._seen[key] = seen
        return self._seen[key]


def _asked(criteria: Sequence[Criterion]) -> Mapping[str, tuple[str, ...]]:
    """By node, the parameters that any criterion looks at."""
    found: dict[str, list[str]] = {}
    for criterion in criteria:
        if isinstance(criterion.params, Parameters):
            for each in criterion.params.parameters:
                node, name, _ = each.split(maxsplit=2)
                found.setdefault(node, []).append(name)
    return {node: tuple(dict.fromkeys(names)) for node, names in found.items()}


def gather(assignment: Assignment, file: Path, conditions: Conditions) -> AbstractContextManager[Gatherer]:
    return nullcontext(_Gathered(assignment, file, conditions))


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (starts, nodes, arguments, parameters, wired, drives)}
)

SORT: Final = Sort((".py",), CHECKS, read, gather)
