"""A layer plan made by hand, in a YAML file: the members of each layer, the layers of each laser, and a proof of minimality.

The submission::

    layers:
      A: [robot, hall]
      B: [drone, hall]
    lasers: {lidar: [A]}
    proof: [robot - hall, drone - hall, lidar sees hall]

``case`` in the assignment names a requirements file beside it (see ``kit.layers.requirements_file``), or one of the kit's examples; it may be in
``secret.yaml`` instead.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import Final

from grader.assignment import Assignment
from grader.check import NoParams, check
from grader.evidence.contract import EvidenceOptions, EvidenceRecord
from grader.kinds.contract import (
    AssignmentFiles,
    KindSettings,
    SubmissionKind,
    collect_once,
    read_submitted_yaml,
)
from grader.kinds.plan.sheet_keys import SHEET_KEYS
from grader.problem_text import numbered
from kit.host.failure import Failure
from kit.layers.assignment import LayerAssignment as Plan
from kit.layers.assignment import NamedLayer, RequirementBreach, find_breaches
from kit.layers.examples import EXAMPLES
from kit.layers.requirements import (
    ContactRequirement,
    LayerCase,
    Requirement,
    SightRequirement,
    layer_conflict,
)
from kit.layers.requirements_file import read_requirements
from kit.plain_text import quoted, suggestion
from kit.world.problems import WorldError
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section

MAX_ENTRIES: Final = 64
"""Layers, and lines of a proof."""
SIGHT_SEPARATOR: Final = " sees "
CONTACT_SEPARATOR: Final = " - "


@dataclass(frozen=True, slots=True)
class SubmittedPlan:
    """The submitted plan together with the requirements it must meet."""

    case: LayerCase
    plan: Plan
    proof: tuple[Requirement, ...]
    unusable_lines: tuple[str, ...] = ()
    """What is wrong with lines of the proof that name nothing that must happen."""

    @property
    def breaches(self) -> tuple[RequirementBreach, ...]:
        return find_breaches(self.case, self.plan)

    def combinable_pairs(self) -> Iterator[str]:
        """Yields the pairs of the proof that one layer could serve; they prove nothing."""
        for one, other in combinations(self.proof, 2):
            if layer_conflict(self.case, one, other) is None:
                yield f"One layer could serve both “{_line(one)}” and “{_line(other)}”"


@check(none=1, full=0, words=("all of them", "not all"))
def complete(evidence: EvidenceRecord, params: NoParams) -> float:
    """Not everything that must happen happens in your plan:"""
    plan: SubmittedPlan = evidence.content
    return float(sum(breach.is_missing for breach in plan.breaches))


@check(none=1, full=0, words=("nothing else", "more than was asked"))
def nothing_more(evidence: EvidenceRecord, params: NoParams) -> float:
    """In your plan something happens that must not:"""
    plan: SubmittedPlan = evidence.content
    return float(sum(not breach.is_missing for breach in plan.breaches))


@check(none=17, full=16, unit="layers")
def few_layers(evidence: EvidenceRecord, params: NoParams) -> float:
    """Your plan has {actual}; it can be done with {full}."""
    submitted: SubmittedPlan = evidence.content
    return float(len(submitted.plan.layers))


@check(none=0, full=1, unit="lines")
def proof(evidence: EvidenceRecord, params: NoParams) -> float:
    """A proof is a list of things that must happen, no two of which fit one layer: then each needs a layer of its
    own. Of yours {actual} count; {full} are wanted."""
    plan: SubmittedPlan = evidence.content
    return 0.0 if _faults_of_proof(plan) else float(len(plan.proof))


CHECKS: Final = (complete, nothing_more, few_layers, proof)


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the requirements."""
    in_secret = not files.public.has("case") and files.secret is not None
    holder = files.secret if in_secret and files.secret is not None else files.public
    name = holder.name("case")
    file = files.folder / name
    if name in EXAMPLES:
        return KindSettings(task=EXAMPLES[name])
    try:
        return KindSettings(task=read_requirements(file).case)
    except WorldError as error:
        holder.error(f"no case: {error}", "case")
        return KindSettings()


def collect_evidence(assignment: Assignment, file: Path, options: EvidenceOptions) -> EvidenceRecord:
    """Reads the submitted plan."""
    case: LayerCase = assignment.task
    plan = read_submitted_yaml(file, lambda section: _read_plan(section, case))
    if isinstance(plan, Failure):
        return EvidenceRecord(failure=plan)
    return EvidenceRecord(plan, label="your plan", explain_with=lambda name, params: _explain(plan, name))


def _explain(plan: SubmittedPlan, name: str) -> str:
    if name == proof.name:
        return numbered(_faults_of_proof(plan))
    if name in (complete.name, nothing_more.name):
        wanted = name == complete.name
        return "; ".join(str(breach) for breach in plan.breaches if breach.is_missing is wanted)
    return ""


def _faults_of_proof(plan: SubmittedPlan) -> tuple[str, ...]:
    return plan.unusable_lines or tuple(plan.combinable_pairs())


def _read_plan(section: Section, case: LayerCase) -> SubmittedPlan:
    layers = []
    inner = _subsection(section, "layers")
    for name in () if inner is None else tuple(inner.keys()):
        assert inner is not None
        layers.append(NamedLayer(name, frozenset(_known_names(inner, name, case.names, "thing"))))
    names = [layer.name for layer in layers]
    watched = _subsection(section, "lasers")
    watches = {}
    for laser in () if watched is None else tuple(watched.keys()):
        assert watched is not None
        if laser not in case.laser:
            watched.error(f"no laser {quoted(laser)}: {suggestion(laser, tuple(case.laser))}", laser)
        watches[laser] = _known_names(watched, laser, names, "layer of yours")
    proof, faults = _read_proof(section, case)
    if max(len(layers), len(proof) + len(faults)) > MAX_ENTRIES:
        section.error(f"at most {MAX_ENTRIES} layers and {MAX_ENTRIES} lines of proof")
    return SubmittedPlan(case, Plan(tuple(layers), watches), proof, faults)


def _read_proof(section: Section, case: LayerCase) -> tuple[tuple[Requirement, ...], tuple[str, ...]]:
    """Returns the lines that must happen, each once, and what is wrong with the others."""
    if section.is_blank("proof"):
        return (), ()
    if not section.is_list("proof"):
        return (), (_at(section.location_of("proof"), "write a list, [one - other, laser sees thing]"),)
    entries = section.value("proof")
    assert isinstance(entries, tuple)
    lines: dict[Requirement, None] = {}
    faults = []
    for number, entry in enumerate(entries):
        line = _requirement("" if entry is None else str(entry))
        if isinstance(entry, Mapping) or line not in case.requirements:
            fault = _fault_of_pair(entry, case) if isinstance(entry, Mapping) else _fault_of_line(line, case)
            faults.append(_at(section.location_of("proof", item=number), fault))
        else:
            lines[line] = None
    return tuple(lines), tuple(faults)


def _at(location: SourceLocation, fault: str) -> str:
    """A fault with its place in the file, whose folder means nothing to its author."""
    return f"{replace(location, file=Path(location.file.name))}: {fault}"


def _subsection(section: Section, key: str) -> Section | None:
    """Returns the section of a key; None where it is empty."""
    return None if section.is_blank(key) else section.section(key, None)


def _known_names(
    section: Section, key: str, known: list[str] | tuple[str, ...], what: str
) -> tuple[str, ...]:
    names = () if section.is_blank(key) else section.texts(key, ())
    for number, name in enumerate(names):
        if name not in known:
            section.error(
                f"there is no {what} named {quoted(name)}: {suggestion(name, known)}", key, item=number
            )
    return names


def _line(requirement: Requirement) -> str:
    """A requirement as a proof has it."""
    if isinstance(requirement, SightRequirement):
        return f"{requirement.laser}{SIGHT_SEPARATOR}{requirement.entity}"
    return f"{requirement.a}{CONTACT_SEPARATOR}{requirement.b}"


def _requirement(line: str) -> Requirement:
    """Reads a line of the proof."""
    split = SIGHT_SEPARATOR if SIGHT_SEPARATOR in line else CONTACT_SEPARATOR
    one, _, other = (part.strip() for part in line.partition(split))
    return SightRequirement(one, other) if split == SIGHT_SEPARATOR else ContactRequirement(one, other)


def _fault_of_pair(entry: Mapping[str, object], case: LayerCase) -> str:
    """Says how to write what was written with a colon."""
    one, other = next(iter(entry.items()), ("one", "other"))
    separator = SIGHT_SEPARATOR if one in case.laser else CONTACT_SEPARATOR
    return f"a colon does not join two things here: write “{one}{separator}{other}”"


def _fault_of_line(line: Requirement, case: LayerCase) -> str:
    """Says why a line of the proof that need not happen proves nothing."""
    named = [line.laser, line.entity] if isinstance(line, SightRequirement) else [line.a, line.b]
    known = [*case.laser, *case.names]
    if "" in named:
        return (
            f"{quoted(next(filter(None, named), ''))} is no pair: write “one - other”, or “laser sees thing”"
        )
    unknown = next((each for each in named if each not in known), None)
    if unknown is not None:
        return f"there is nothing named {quoted(unknown)}: {suggestion(unknown, known)}"
    return f"“{_line(line)}” is not among what must happen here, so it proves nothing"


KIND: Final = SubmissionKind(
    (".yaml", ".yml"),
    {each.name: each for each in CHECKS},
    read_settings,
    collect_once(collect_evidence),
    sheet_keys=SHEET_KEYS,
)
