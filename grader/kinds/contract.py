"""What a kind of assignment is, and the simplest evidence there is: one look at what was handed in."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

from grader.checks.contract import Check
from kit.host.failure import Failure, FailureKind
from kit.host.sandbox.confinement import Level
from kit.host.wire import printable
from kit.world.documents import Documents
from kit.world.files import Enclosure
from kit.world.problems import Problems, WorldError
from kit.world.records import Place
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from grader.assignment import Assignment, Criterion, Trial
    from grader.grading import Evidence, EvidenceCollector

Parsed = TypeVar("Parsed")

KINDS_PACKAGE: Final = "grader.kinds"
NON_KIND_MODULES: Final = ("contract",)


@dataclass(frozen=True, slots=True)
class AssignmentFiles:
    """An assignment's files while they are read."""

    folder: Path
    public: Section
    """``assignment.yaml``"""
    secret: Section | None
    """``secret.yaml``, where there is one."""


@dataclass(frozen=True, slots=True)
class KindSettings:
    """What a kind reads of the sheet for itself."""

    trials: tuple[Trial, ...] = ()
    """Kinds of episodes, where the kind has episodes."""
    task: Any = None
    """The kind's own record."""


@dataclass(frozen=True, slots=True)
class EvidenceOptions:
    """How one submission is to be looked at."""

    level: Level
    secret: bool
    may_fall: bool
    """Whether a machine that cannot confine so far may confine less."""


@dataclass(frozen=True, slots=True)
class Kind:
    """One kind of assignment."""

    endings: tuple[str, ...]
    """What the name of the file handed in may end with."""
    checks: Mapping[str, Check]
    """By name."""
    read_settings: Callable[[AssignmentFiles], KindSettings]
    """Notes mistakes in the sections; need not finish them."""
    collect: Callable[[Assignment, Path, EvidenceOptions], AbstractContextManager[EvidenceCollector]]
    """(assignment, the main file handed in, conditions) -> who gathers evidence."""


def kind_names() -> tuple[str, ...]:
    """Every kind there is, by name."""
    package = import_module(KINDS_PACKAGE)
    return tuple(
        sorted(
            each.name for each in pkgutil.iter_modules(package.__path__) if each.name not in NON_KIND_MODULES
        )
    )


def find_kind(kind: str) -> Kind:
    """The kind's record; its module is imported when it is first asked for."""
    kind_record: Kind = import_module(f"{KINDS_PACKAGE}.{kind}").KIND
    return kind_record


@dataclass(eq=False)
class EvidenceRecord:
    """One look at what was handed in: what was found, or why nothing could be found."""

    found: Any = None
    """The kind's own record, for its checks."""
    failure: Failure | None = None
    label: str = "what you handed in"
    secret: bool = False
    outcome: str = "looked at"
    steps: int = 0
    printed: tuple[str, ...] = ()
    explain_with: Callable[[str, Any], str] = lambda check, params: ""
    """(a check's name, its params) -> what else there is to say."""
    draw_with: Callable[[str], str] = lambda check: ""

    def explain(self, check: str, params: Any) -> str:
        return self.explain_with(check, params)

    def picture(self, check: str = "") -> str:
        return self.draw_with(check)


class FixedEvidence:
    """A gatherer of evidence that is gathered once, for every criterion the same."""

    def __init__(self, evidence: Sequence[Evidence], level: Level) -> None:
        self.level = level
        self._evidence = tuple(evidence)

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._evidence

    def all(self) -> Sequence[Evidence]:
        return self._evidence


def read_submitted_yaml(file: Path, make: Callable[[Section], Parsed]) -> Parsed | Failure:
    """What a handed-in YAML file says; or all its mistakes, each with its place, as one failure."""
    problems = Problems()
    try:
        section = Documents(Enclosure.of(file.parent), {}, problems).section(file, Place(file))
        problems.raise_if_any()
        assert section is not None  # None is noted as a problem
        parsed = make(section)
        problems.raise_if_any()
    except (WorldError, OSError) as error:
        # Where the snapshot lies is nothing to tell.
        return Failure(FailureKind.IMPORT, printable(str(error).replace(f"{file.parent}/", "")))
    return parsed


def collect_once(
    collect_evidence: Callable[[Assignment, Path, EvidenceOptions], EvidenceRecord],
) -> Callable[..., AbstractContextManager[EvidenceCollector]]:
    """``Kind.collect`` for a kind that looks once."""

    def collect(
        assignment: Assignment, file: Path, options: EvidenceOptions
    ) -> AbstractContextManager[EvidenceCollector]:
        return nullcontext(FixedEvidence([collect_evidence(assignment, file, options)], options.level))

    return collect
