"""A guided tour of a case, page by page: what is asked, the slides' method, the fewest layers, why there are no fewer.

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
from kit.layers.assignment import LayerAssignment, NamedLayer
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.greedy import ChoiceFunction, GreedyRun, run_greedy
from kit.layers.planning import LayerPlan
from kit.layers.requirements import ContactRequirement, LayerCase, SightRequirement
from kit.plain_text import counted, join_with_and

T = TypeVar("T")

MAX_PAIRS_IN_WORDS = 4
"""Requirements of which every two are compared in words; of more, some pairs stand for all."""

TourPart = Literal["case", "method", "fewest", "proof"]


@dataclass(frozen=True, slots=True)
class TourPage:
    """One step, and what to draw with it."""

    part: TourPart
    title: str
    lines: tuple[str, ...]
    covered_edges: frozenset[ContactRequirement] = frozenset()
    group: frozenset[str] = frozenset()
    laser: str | None = None
    step: int | None = None
    """The number, from 0, of the collision step of the method that this is."""
    layers: tuple[NamedLayer, ...] = ()
    """The layers there are by now."""
    watches: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Which of them each laser watches by now."""


@dataclass(frozen=True)
class GreedyTour:
    """The slides' method on a case, with some edges chosen by the user and the first available otherwise."""

    case: LayerCase
    chosen_edges: Mapping[int, ContactRequirement] = field(default_factory=dict)
    """Edges by the number of the choice, counted over the whole run."""

    @cached_property
    def run(self) -> GreedyRun:
        return run_greedy(self.case, choose=self._choice_function())

    def edges(self, step: int) -> tuple[ContactRequirement, ...]:
        """Every edge that this step could begin with."""
        return self.run.collision_steps[step].choices

    def with_edge(self, step: int, edge: ContactRequirement) -> GreedyTour:
        """The method with another edge at this step; what came before stays, what comes after starts again."""
        number = sum(1 + len(done.growth) for done in self.run.collision_steps[:step])
        kept = {place: earlier for place, earlier in self.chosen_edges.items() if place < number}
        return GreedyTour(self.case, {**kept, number: edge})

    def _choice_function(self) -> ChoiceFunction:
        numbers = count()

        def choose(choices: Sequence[T], /) -> T:
            wanted = self.chosen_edges.get(next(numbers))
            return next((choice for choice in choices if choice == wanted), choices[0])

        return choose


def case_page(case: LayerCase, width: int) -> TourPage:
    """Returns the page that shows the requirements."""
    lines = words.case_text(case, width=width)
    title = words.paragraph(case.title, width=width)
    return TourPage("case", "What is asked", (*title, *([""] if title else []), *lines))


def method_pages(run: GreedyRun, width: int) -> Iterator[TourPage]:
    """The slides' method, clique by clique, then laser by laser, then where it led."""
    case, steps = run.case, run.collision_steps
    for number, step in enumerate(steps):
        lines = words.collision_step_text(case, number + 1, step, width=width)
        title = f"The slides' method, layer {number + 1} of {len(steps)}"
        layers = tuple(done.layer for done in steps[: number + 1])
        yield TourPage(
            "method",
            title,
            tuple(lines),
            run.covered_before(number),
            step.layer.members,
            step=number,
            layers=layers,
        )
    struck = run.covered_before(len(steps))
    layers = tuple(step.layer for step in steps)
    watches: dict[str, tuple[str, ...]] = {}
    for laser in run.laser_steps:
        lines = words.laser_step_text(case, laser, width=width)
        title = f"The slides' method, laser {laser.laser}"
        layers = (*layers, *laser.added)
        watches = {**watches, laser.laser: laser.watches}
        yield TourPage(
            "method", title, tuple(lines), struck, laser=laser.laser, layers=layers, watches=watches
        )
    ending = (*words.greedy_end_text(run, width=width), "", *layer_listing(case, run.assignment, width))
    yield TourPage(
        "method",
        "Where the slides' method ends",
        ending,
        struck,
        layers=run.assignment.layers,
        watches=run.assignment.watches,
    )


def plan_pages(
    case: LayerCase, plan: LayerPlan, world_plan: WorldPlan | None, run: GreedyRun, width: int
) -> Iterator[TourPage]:
    """The fewest layers, all and one by one, and the proof; in a world's own names where there is one. ``run``: what
    the slides' method comes to."""
    assignment = plan.assignment if world_plan is None else world_plan.assignment
    size = len(assignment.layers)
    overview = (
        *([] if world_plan is None else _current_layers(world_plan, width)),
        *words.layer_count_text(plan, width=width),
        *words.comparison_text(run, plan, width=width),
        "",
        *layer_listing(case, assignment, width),
    )
    all_layers, watches = assignment.layers, assignment.watches
    yield TourPage("fewest", "The fewest layers", overview, layers=all_layers, watches=watches)
    struck: frozenset[ContactRequirement] = frozenset()
    for number, layer in enumerate(assignment.layers, start=1):
        title = f"The fewest layers, {number} of {size}"
        yield TourPage(
            "fewest",
            title,
            tuple(_layer_page(case, assignment, layer, width)),
            struck,
            layer.members,
            layers=all_layers[:number],
            watches=watches,
        )
        struck |= {edge for edge in case.edges() if layer.members.issuperset((edge.a, edge.b))}
    named = {
        *plan.certificate.conflicting,
        *(named for part in plan.certificate.weighted_parts for named in part),
    }
    others = frozenset(edge for edge in case.edges() if edge not in named)
    few = len(plan.certificate.conflicting) <= MAX_PAIRS_IN_WORDS
    lines = words.proof_text(plan, every_pair=few, width=width)
    yield TourPage("proof", "Why no plan has fewer", tuple(lines), others, layers=all_layers, watches=watches)


def _current_layers(world_plan: WorldPlan, width: int) -> list[str]:
    """Returns the text on the world's present layers."""
    lines = words.paragraph(
        f"Today the world names {counted(world_plan.current_name_count, 'layer')}.", width=width
    )
    if wrong := len(world_plan.current_breaches):
        lines += words.paragraph(
            f"In {wrong} ways it does not do what is asked: kit layers check.", width=width
        )
    return lines


def layer_listing(case: LayerCase, assignment: LayerAssignment, width: int) -> list[str]:
    """Every layer with what it holds and who watches it."""
    return [line for layer in assignment.layers for line in _layer_heading(case, assignment, layer, width)]


def _layer_heading(case: LayerCase, assignment: LayerAssignment, layer: NamedLayer, width: int) -> list[str]:
    watchers = [name for name, watched in assignment.watches.items() if layer.name in watched]
    seen = f", watched by {join_with_and(watchers)}" if watchers else ""
    members = words.members_text(case, layer.members)
    return words.paragraph(f"{layer.name} = {members}{seen}", width=width, later="  ")


def _layer_page(case: LayerCase, assignment: LayerAssignment, layer: NamedLayer, width: int) -> Iterator[str]:
    """One layer of a plan and what it brings about."""
    say = partial(words.paragraph, width=width, indent="  ", later="    ")
    yield from _layer_heading(case, assignment, layer, width)
    yield "It brings about:"
    for requirement in case.requirements:
        if isinstance(requirement, SightRequirement):
            watched = layer.name in assignment.watches.get(requirement.laser, ())
            served = watched and requirement.entity in layer.members
        else:
            served = layer.members.issuperset((requirement.a, requirement.b))
        if served:
            yield from say(words.requirement_text(requirement, case))
