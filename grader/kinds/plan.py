"""A layer plan made by hand, in a YAML file: who shares which layer, what each laser watches, and why fewer will not do.

What is handed in::

    layers:
      A: [robot, hall]
      B: [drone, hall]
    lasers: {lidar: [A]}
    proof: [robot - hall, drone - hall, lidar sees hall]

The sheet's ``case`` names a requirements file beside it (see ``kit.layers.reading``), or one of the kit's examples; it may stand in
``secret.yaml`` instead.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Final

from grader.assignment import Assignment
from grader.checks.contract import NoParams, check
from grader.kinds.contract import Conditions, Look, Sheet, Sort, Task, from_yaml, once
from kit.host.failure import Failure
from kit.layers.assignment import Assignment as Plan
from kit.layers.assignment import Breach, NamedLayer, breaches
from kit.layers.examples import EXAMPLES
from kit.layers.reading import read_requirements
from kit.layers.requirements import Case, Contact, Requirement, Sight, fit_together
from kit.world.problems import WorldError, quoted, suggestion
from kit.world.yaml_section import Section

MOST: Final = 64
"""Layers, and lines of a proof."""
SEES: Final = " sees "
MEETS: Final = " - "


@dataclass(frozen=True, slots=True)
class Made:
    """What was handed in, beside what was asked."""

    case: Case
    plan: Plan
    proof: tuple[Requirement, ...]

    @property
    def wrong(self) -> tuple[Breach, ...]:
        return breaches(self.case, self.plan)

    def fits(self) -> Iterator[str]:
        """Pairs of the proof that one layer could serve, which prove nothing."""
        for one, other in combinations(self.proof, 2):
            if fit_together(self.case, one, other) is None:
                yield f"one layer could serve both “{one}” and “{other}”"


@check(none=1, full=0, words=("all of them", "not all"))
def complete(look: Look, params: NoParams) -> float:
    """Not everything that must happen happens in your plan:"""
    return float(sum(breach.wanted for breach in look.found.wrong))


@check(none=1, full=0, words=("nothing else", "more than was asked"))
def nothing_more(look: Look, params: NoParams) -> float:
    """In your plan something happens that must not:"""
    return float(sum(not breach.wanted for breach in look.found.wrong))


@check(none=17, full=16, unit="layers")
def few_layers(look: Look, params: NoParams) -> float:
    """Your plan has {actual}; it can be done with {full}."""
    return float(len(look.found.plan.layers))


@check(none=0, full=1, unit="lines")
def proof(look: Look, params: NoParams) -> float:
    """A proof is a list of things that must happen, no two of which fit one layer: then each needs a layer of its
    own. Yours proves {actual}; {full} are wanted."""
    made: Made = look.found
    return 0.0 if next(made.fits(), None) else float(len(made.proof))


CHECKS: Final = (complete, nothing_more, few_layers, proof)


def read(sheet: Sheet) -> Task:
    """The case."""
    in_secret = not sheet.public.has("case") and sheet.secret is not None
    holder = sheet.secret if in_secret and sheet.secret is not None else sheet.public
    name = holder.name("case")
    file = sheet.folder / name
    if name in EXAMPLES:
        return Task(content=EXAMPLES[name])
    try:
        return Task(content=read_requirements(file).case)
    except WorldError as error:
        holder.error(f"no case: {error}", "case")
        return Task()


def look(assignment: Assignment, file: Path, conditions: Conditions) -> Look:
    """Reads the plan."""
    case: Case = assignment.task
    made = from_yaml(file, lambda section: _made(section, case))
    if isinstance(made, Failure):
        return Look(failure=made)
    return Look(made, label="your plan", remarks=lambda name, params: _remark(made, name))


def _remark(made: Made, name: str) -> str:
    if name == proof.name:
        return "; ".join(made.fits())
    if name in (complete.name, nothing_more.name):
        wanted = name == complete.name
        return "; ".join(str(breach) for breach in made.wrong if breach.wanted is wanted)
    return ""


def _made(section: Section, case: Case) -> Made:
    layers = []
    inner = _inner(section, "layers")
    for name in () if inner is None else tuple(inner.keys()):
        assert inner is not None
        layers.append(NamedLayer(name, frozenset(_known(inner, name, case.names, "thing"))))
    names = [layer.name for layer in layers]
    watched = _inner(section, "lasers")
    watches = {}
    for laser in () if watched is None else tuple(watched.keys()):
        assert watched is not None
        if laser not in case.laser:
            watched.error(f"no laser {quoted(laser)}: {suggestion(laser, tuple(case.laser))}", laser)
        watches[laser] = _known(watched, laser, names, "layer of yours")
    said = () if section.is_blank("proof") else section.texts("proof", ())
    lines = tuple(_requirement(section, line, case) for line in said)
    if max(len(layers), len(lines)) > MOST:
        section.error(f"at most {MOST} layers and {MOST} lines of proof")
    section.finish()
    return Made(case, Plan(tuple(layers), watches), tuple(dict.fromkeys(each for each in lines if each)))


def _inner(section: Section, key: str) -> Section | None:
    """A mapping; None where nothing is written yet."""
    return None if section.is_blank(key) else section.section(key, None)


def _known(section: Section, key: str, known: list[str] | tuple[str, ...], what: str) -> tuple[str, ...]:
    names = () if section.is_blank(key) else section.texts(key, ())
    for name in names:
        if name not in known:
            section.error(f"there is no {what} called {quoted(name)}: {suggestion(name, known)}", key)
    return names


def _requirement(section: Section, line: str, case: Case) -> Requirement | None:
    """What a line of the proof says must happen."""
    split = SEES if SEES in line else MEETS
    one, _, other = (part.strip() for part in line.partition(split))
    made: Requirement = Sight(one, other) if split == SEES else Contact(one, other)
    if made in case.requirements:
        return made
    section.error(f"{quoted(line)} is nothing that must happen here: write A - B, or LASER sees A", "proof")
    return None


SORT: Final = Sort((".yaml", ".yml"), {each.name: each for each in CHECKS}, read, once(look))
