"""A case gone through page by page: what is asked, the slides' method, the fewest layers, why there are no fewer.

Each page is a few words and what is to stand out in the picture of the graph; how they are shown is a face's
business.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import count
from typing import Literal, TypeVar

from kit.layers import explain as words
from kit.layers.assignment import Assignment, NamedLayer
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.greedy import Chooser, GreedyRun, greedy
from kit.layers.planning import Plan
from kit.layers.requirements import Case, Contact, Sight

T = TypeVar("T")

FEW = 4
"""Requirements of which every two are compared in words; of more, some pairs stand for all."""

Part = Literal["case", "method", "fewest", "proof"]


@dataclass(frozen=True, slots=True)
class Page:
    """One step, and what to draw with it."""

    part: Part
    title: str
    words: tuple[str, ...]
    struck: frozenset[Contact] = frozenset()
    group: frozenset[str] = frozenset()
    laser: str | None = None
    step: int | None = None
    """The number, from 0, of the collision step of the method that this is."""


@dataclass(frozen=True)
class Method:
    """The slides' method on a case, as somebody does it: some edges chosen, the others the first there are."""

    case: Case
    wanted: Mapping[int, Contact] = field(default_factory=dict)
    """Edges by the number of the choice, counted over the whole run."""

    @cached_property
    def run(self) -> GreedyRun:
        return greedy(self.case, choose=self._chooser())

    def edges(self, step: int) -> tuple[Contact, ...]:
        """Every edge that this step could begin with."""
        return self.run.collision_steps[step].choices

    def beginning_with(self, step: int, edge: Contact) -> Method:
        """The method with another edge at this step; what came before stays, what comes after starts anew."""
        number = sum(1 + len(done.growth) for done in self.run.collision_steps[:step])
        kept = {place: earlier for place, earlier in self.wanted.items() if place < number}
        return Method(self.case, {**kept, number: edge})

    def _chooser(self) -> Chooser:
        numbers = count()

        def choose(choices: Sequence[T], /) -> T:
            wanted = self.wanted.get(next(numbers))
            return next((choice for choice in choices if choice == wanted), choices[0])

        return choose


def case_page(case: Case, width: int) -> Page:
    """What is asked."""
    said = words.case_in_words(case, width=width)
    title = words.wrapped(case.title, width=width)
    return Page("case", "What is asked", (*title, *([""] if title else []), *said))


def method_pages(run: GreedyRun, width: int) -> Iterator[Page]:
    """The slides' method, clique by clique, then laser by laser, then where it led."""
    case, steps = run.case, run.collision_steps
    for number, step in enumerate(steps):
        said = words.collision_step_in_words(case, number + 1, step, width=width)
        title = f"The slides' method, layer {number + 1} of {len(steps)}"
        yield Page("method", title, tuple(said), run.struck_before(number), step.layer.members, step=number)
    struck = run.struck_before(len(steps))
    for laser in run.laser_steps:
        said = words.laser_step_in_words(case, laser, width=width)
        yield Page(
            "method", f"The slides' method, laser {laser.laser}", tuple(said), struck, laser=laser.laser
        )
    ending = (*words.greedy_end_in_words(run, width=width), "", *listing(case, run.assignment, width))
    yield Page("method", "Where the slides' method ends", ending, struck)


def plan_pages(
    case: Case, plan: Plan, world_plan: WorldPlan | None, run: GreedyRun, width: int
) -> Iterator[Page]:
    """The fewest layers, all and one by one, and the proof; in a world's own names where there is one. ``run``: what
    the slides' method comes to."""
    assignment = plan.assignment if world_plan is None else world_plan.assignment
    size = len(assignment.layers)
    overview = (
        *([] if world_plan is None else _today(world_plan, width)),
        *words.plan_in_words(plan, width=width),
        *words.comparison_in_words(run, plan, width=width),
        "",
        *listing(case, assignment, width),
    )
    yield Page("fewest", "The fewest layers", overview)
    struck: frozenset[Contact] = frozenset()
    for number, layer in enumerate(assignment.layers, start=1):
        title = f"The fewest layers, {number} of {size}"
        yield Page("fewest", title, tuple(_layer(case, assignment, layer, width)), struck, layer.members)
        struck |= {edge for edge in case.edges() if layer.members.issuperset((edge.a, edge.b))}
    named = {*plan.certificate.apart, *(named for part in plan.certificate.parts for named in part)}
    others = frozenset(edge for edge in case.edges() if edge not in named)
    few = len(plan.certificate.apart) <= FEW
    said = words.proof_in_words(plan, every_pair=few, width=width)
    yield Page("proof", "Why no plan has fewer", tuple(said), others)


def _today(world_plan: WorldPlan, width: int) -> list[str]:
    """What the world has at present."""
    said = words.wrapped(
        f"Today the world names {words.layers_in_words(world_plan.names_today)}.", width=width
    )
    if wrong := len(world_plan.wrong_today):
        said += words.wrapped(f"In {wrong} ways it does not do what is asked: kit layers check.", width=width)
    return said


def listing(case: Case, assignment: Assignment, width: int) -> list[str]:
    """Every layer with what it holds and who watches it."""
    return [line for layer in assignment.layers for line in _head(case, assignment, layer, width)]


def _head(case: Case, assignment: Assignment, layer: NamedLayer, width: int) -> list[str]:
    watchers = [name for name, watched in assignment.watches.items() if layer.name in watched]
    seen = f", watched by {words.listed(watchers)}" if watchers else ""
    members = words.members_in_words(case, layer.members)
    return words.wrapped(f"{layer.name} = {members}{seen}", width=width, later="  ")


def _layer(case: Case, assignment: Assignment, layer: NamedLayer, width: int) -> Iterator[str]:
    """One layer of a plan and what it brings about."""
    say = partial(words.wrapped, width=width, indent="  ", later="    ")
    yield from _head(case, assignment, layer, width)
    yield "It brings about:"
    for requirement in case.requirements:
        if isinstance(requirement, Sight):
            watched = layer.name in assignment.watches.get(requirement.laser, ())
            served = watched and requirement.entity in layer.members
        else:
            served = layer.members.issuperset((requirement.a, requirement.b))
        if served:
            yield from say(words.requirement_in_words(requirement, case))
