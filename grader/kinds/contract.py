"""Kinds of assignment: the record each kind module offers, how it is found, and what several kinds share."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, TypeVar

from grader.assignment import Assignment, Trial
from grader.check import Check
from grader.evidence.contract import EvidenceCollector, EvidenceOptions, EvidenceRecord, SingleEvidence
from grader.problem_text import problems_text
from grader.submitted_files import reading_submission
from kit.extensions import Extension, ExtensionError, extensions, load
from kit.host.failure import Failure, FailureKind
from kit.host.sandbox.limits import GRADER_LIMITS, Limits
from kit.world.documents import open_document
from kit.world.problems import WorldError
from kit.world.yaml_section import Section

Parsed = TypeVar("Parsed")

Part = TypeVar("Part")

KINDS_PACKAGE: Final = "grader.kinds"


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
    """What a kind reads from the assignment's files for itself."""

    trials: tuple[Trial, ...] = ()
    """Kinds of episodes, where the kind has episodes."""
    task: Any = None
    """The kind's own record."""
    secret_seeds: tuple[int, ...] = ()
    """Secret seeds, besides those of trials."""


@dataclass(frozen=True, slots=True)
class SubmissionKind:
    """One kind of assignment."""

    endings: tuple[str, ...]
    """Endings that the submitted file's name may have."""
    checks: Mapping[str, Check]
    """Checks by name."""
    read_settings: Callable[[AssignmentFiles], KindSettings]
    """Notes mistakes in the sections; need not finish these."""
    collect: Callable[[Assignment, Path, EvidenceOptions], AbstractContextManager[EvidenceCollector]]
    """(assignment, the main submitted file, options) -> the collector of its evidence."""
    seed_decides: str = ""
    """A sentence on what differs between seeds: for a student whose work is right with the public ones alone."""
    limits: Limits = GRADER_LIMITS
    """Limits of each of its processes, where the assignment's budget sets no others."""
    sheet_keys: Mapping[str, str] = field(default_factory=dict)
    """What each key means that ``read_settings`` asks for, by its path: ``functions.within``. An entry of a list or of a mapping
    adds nothing to a path, or ``NAME``; keys of ``secret.yaml`` begin with ``secret.``."""
    exercise: str = ""
    """The lessons' exercise that is its example, ``LESSON/EXERCISE``, where it has no folder in ``grader/templates``."""


@cache
def _own_kinds() -> tuple[str, ...]:
    package = import_module(KINDS_PACKAGE)
    return tuple(sorted(each.name for each in pkgutil.iter_modules(package.__path__) if each.ispkg))


def kind_names() -> tuple[str, ...]:
    """Returns the names of all kinds, those of admitted packages last."""
    return (*_own_kinds(), *extensions("kinds", _own_kinds()))


def find_kind(kind: str) -> SubmissionKind:
    """Returns a kind's record, ``KIND`` of the module ``kind`` in its folder, with the checks that admitted packages add to
    it; imports its module on first use. Raises ExtensionError if a package's part cannot be used."""
    if kind in _own_kinds():
        found: SubmissionKind = import_module(f"{KINDS_PACKAGE}.{kind}.kind").KIND
    else:
        found = _loaded(extensions("kinds")[kind], SubmissionKind)
    prefix = f"{kind}."
    own = [f"{prefix}{name}" for name in found.checks]
    added = {
        name.removeprefix(prefix): _loaded(each, Check)
        for name, each in extensions("checks", own).items()
        if name.startswith(prefix)
    }
    return replace(found, checks=MappingProxyType({**found.checks, **added})) if added else found


def _loaded(extension: Extension, kind: type[Part]) -> Part:
    found = load(extension)
    if not isinstance(found, kind):
        raise ExtensionError(
            f"The part {extension.name} of {extension.source} is no {kind.__name__}, but a {type(found).__name__}."
        )
    return found


def read_submitted_yaml(file: Path, make: Callable[[Section], Parsed]) -> Parsed | Failure:
    """Reads a submitted YAML file with ``make``; returns all its mistakes as one failure if there are any."""
    try:
        with reading_submission(file.name, WorldError, OSError), open_document(file) as section:
            return make(section)
    except (WorldError, OSError) as error:
        return Failure(FailureKind.IMPORT, problems_text(error, file.parent))


def collect_once(
    collect_evidence: Callable[[Assignment, Path, EvidenceOptions], EvidenceRecord],
    *,
    runs_program: bool = True,
) -> Callable[..., AbstractContextManager[EvidenceCollector]]:
    """Makes a ``SubmissionKind.collect`` for a kind with one piece of evidence. Where that is made with a secret seed, the
    public counterpart is collected too when somebody asks for it. ``runs_program``: see ``SingleEvidence``."""

    def collect(
        assignment: Assignment, file: Path, options: EvidenceOptions
    ) -> AbstractContextManager[EvidenceCollector]:
        public = replace(options, secret=False)
        is_secret = options.secret and bool(assignment.secret_seeds)
        collected = SingleEvidence(
            lambda: collect_evidence(assignment, file, options),
            options.level,
            (lambda: collect_evidence(assignment, file, public)) if is_secret else None,
            runs_program=runs_program,
        )
        return nullcontext(collected)

    return collect
