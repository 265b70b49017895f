"""The slides' method, as a person does it with pencil and paper: fast and always valid, but not always minimal.

    1  Draw the collision graph and list its edges. Choose an edge that is not struck; its two ends are a group.
       Add whatever vertex is joined to everyone in the group, until no vertex is. The group is a layer: strike
       the edges inside it. Repeat until every edge is struck. (A struck edge may be used again.)
    2  Take the lasers one by one. In each collision layer, the laser's group are the members it must see. A
       group that is the whole layer needs no new layer, nor does one that an earlier laser has made. Of the
       rest, those inside another group of this laser are dropped; each that remains is a new layer.

Complexity: O(edges * vertices^2) for 1, and O(lasers * layers^2) for 2. Related heuristics: Kellerman (1973),
and Kou, Stockmeyer and Wong (1978), who go through vertices rather than edges and drop superfluous cliques.

What it gets right: every group is a clique of required contacts, and every group of a laser is made of what that
laser must see; so nothing ever collides or is seen that should not be. What it does not:

    - the number of layers depends on the choices, and no choice need lead to the fewest (``examples``);
    - a group of a laser is dropped only when *one* other holds it, though several together may;
    - an entity that collides with nothing is in no collision layer, so the lasers never find it (``missed``);
    - it knows nothing of pairs that may share a layer: they are no edges, and no group can use them.

References
    E. Kellerman. Determination of keyword conflict. IBM Technical Disclosure Bulletin 16 (1973).
    L. T. Kou, L. J. Stockmeyer, C. K. Wong. Covering edges by cliques with regard to keyword conflicts and
        intersection graphs. Communications of the ACM 21 (1978). doi:10.1145/359340.359346
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, TypeVar

from kit.layers.assignment import LayerAssignment, NamedLayer
from kit.layers.requirements import ContactRequirement, LaserEntity, LayerCase, SightRequirement

T = TypeVar("T")


class ChoiceFunction(Protocol):
    """Takes one of several choices that are all right: ``random.Random(seed).choice``, or the player."""

    def __call__(self, choices: Sequence[T], /) -> T: ...


def first_choice(choices: Sequence[T], /) -> T:
    """Returns the first choice."""
    return choices[0]


@dataclass(frozen=True, slots=True)
class GrowthStep:
    """One vertex joins the group."""

    added: str
    choices: tuple[str, ...]
    """Every vertex that could have joined at this point, the one that did included."""


@dataclass(frozen=True, slots=True)
class CollisionStep:
    """One collision layer: an edge chosen, its group grown, the edges inside struck."""

    edge: ContactRequirement
    choices: tuple[ContactRequirement, ...]
    """Every edge not struck before this step."""
    growth: tuple[GrowthStep, ...]
    layer: NamedLayer
    covered_edges: tuple[ContactRequirement, ...]
    """The edges this step strikes."""


GroupOutcome = Literal["whole layer", "known group", "new layer", "inside another"]


@dataclass(frozen=True, slots=True)
class LaserGroup:
    """The members of one collision layer that a laser must see, and how the method serves them."""

    source: str
    members: frozenset[str]
    outcome: GroupOutcome
    layer: str
    """The layer that shows this group to the laser."""


@dataclass(frozen=True, slots=True)
class LaserStep:
    """One laser: its groups, and the layers it is to watch."""

    laser: str
    groups: tuple[LaserGroup, ...]
    watches: tuple[str, ...]
    added: tuple[NamedLayer, ...]
    missed: tuple[SightRequirement, ...]
    """Requirements that it does not meet, because no collision layer holds the entity."""


@dataclass(frozen=True, slots=True)
class GreedyRun:
    """A whole run of the method, step by step, and its result."""

    case: LayerCase
    collision_steps: tuple[CollisionStep, ...]
    laser_steps: tuple[LaserStep, ...]
    assignment: LayerAssignment

    @property
    def size(self) -> int:
        return len(self.assignment.layers)

    @property
    def missed(self) -> tuple[SightRequirement, ...]:
        return tuple(sight for step in self.laser_steps for sight in step.missed)

    def covered_before(self, step: int) -> frozenset[ContactRequirement]:
        """The edges already struck when collision step number ``step`` (from 0) begins."""
        return frozenset(edge for done in self.collision_steps[:step] for edge in done.covered_edges)


def run_greedy(case: LayerCase, *, choose: ChoiceFunction = first_choice) -> GreedyRun:
    """The method's layers, with every step and the choices it had. ``choose`` picks edges and vertices."""
    collision_steps: list[CollisionStep] = []
    struck: set[ContactRequirement] = set()
    while choices := _uncovered_edges(case, struck):
        step = grow_collision_layer(case, choices, f"C{len(collision_steps) + 1}", choose=choose)
        collision_steps.append(step)
        struck.update(c for c in case.collide if c.a in step.layer.members and c.b in step.layer.members)
    layers = [step.layer for step in collision_steps]
    laser_steps: list[LaserStep] = []
    for laser in case.lasers:
        groups_so_far = [layer for step in laser_steps for layer in step.added]
        laser_steps.append(add_laser_layers(case, laser, layers, groups_so_far))
    added = [layer for step in laser_steps for layer in step.added]
    return GreedyRun(
        case,
        tuple(collision_steps),
        tuple(laser_steps),
        LayerAssignment((*layers, *added), {step.laser: step.watches for step in laser_steps}),
    )


def _uncovered_edges(case: LayerCase, struck: set[ContactRequirement]) -> tuple[ContactRequirement, ...]:
    """The edges not struck yet. What has to be in some layer, no matter which, waits until the last."""
    edges = tuple(edge for edge in case.edges() if edge not in struck)
    return edges or tuple(contact for contact in case.collide if contact not in struck)


def grow_collision_layer(
    case: LayerCase,
    choices: tuple[ContactRequirement, ...],
    name: str,
    *,
    choose: ChoiceFunction = first_choice,
) -> CollisionStep:
    """One layer called ``name``, grown from one of the edges not struck yet."""
    edge = choose(choices)
    group = {edge.a, edge.b}
    growth: list[GrowthStep] = []
    # Invariant: the group is a complete subgraph of the collision graph.
    while joining := common_neighbours(case, group):
        added = choose(joining)
        growth.append(GrowthStep(added, joining))
        group.add(added)
    struck = tuple(e for e in choices if e.a in group and e.b in group)
    return CollisionStep(edge, choices, tuple(growth), NamedLayer(name, frozenset(group)), struck)


def common_neighbours(case: LayerCase, group: set[str]) -> tuple[str, ...]:
    """The vertices outside the group that collide with everyone in it."""
    return tuple(
        name
        for name in case.names
        if name not in group
        and all(ContactRequirement(name, member) in case.required_contacts for member in group)
    )


def add_laser_layers(
    case: LayerCase, laser: LaserEntity, layers: Sequence[NamedLayer], known: Sequence[NamedLayer]
) -> LaserStep:
    """Finds the layers for one laser, given the collision layers and the layers that earlier lasers have added."""
    shown = {layer.name: layer.members & laser.sees for layer in layers}
    largest: list[frozenset[str]] = []
    for members in shown.values():
        if members and members not in largest and not any(members < other for other in shown.values()):
            largest.append(members)
    whole = {layer.members: layer.name for layer in reversed(layers)}
    earlier = {layer.members: layer.name for layer in known}
    added: list[NamedLayer] = []
    names: dict[frozenset[str], tuple[str, GroupOutcome]] = {}
    for members in largest:
        if members in whole:
            names[members] = whole[members], "whole layer"
        elif members in earlier:
            names[members] = earlier[members], "known group"
        else:
            added.append(NamedLayer(f"L{len(known) + len(added) + 1}", members))
            names[members] = added[-1].name, "new layer"
    groups = []
    met: set[frozenset[str]] = set()
    for source, members in shown.items():
        if members:
            home = next(other for other in largest if members <= other)
            name, fate = names[home]
            groups.append(
                LaserGroup(
                    source, members, "inside another" if members != home or home in met else fate, name
                )
            )
            met.add(members)
    seen = frozenset().union(*shown.values())
    return LaserStep(
        laser.name,
        tuple(groups),
        tuple(names[members][0] for members in largest),
        tuple(added),
        tuple(SightRequirement(laser.name, name) for name in case.names if name in laser.sees - seen),
    )
