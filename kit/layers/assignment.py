"""Layer assignments: named layers with their members and the lasers that watch them, and checks against a case.

``find_breaches`` checks any assignment (of the planner, the slides or a world file) by nothing but the
definition: two entities meet when they share a layer, and a laser sees an entity when it watches one of its layers.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

from kit.layers.requirements import ContactRequirement, LayerCase, Requirement, SightRequirement


@dataclass(frozen=True, slots=True)
class NamedLayer:
    name: str
    members: frozenset[str]


@dataclass(frozen=True)
class LayerAssignment:
    """Layers in order, and for every laser the names of those it watches."""

    layers: tuple[NamedLayer, ...]
    watches: Mapping[str, tuple[str, ...]]

    def layers_of(self, entity: str) -> tuple[str, ...]:
        """Returns the entity's ``layers`` list."""
        return self._layers_by_entity.get(entity, ())

    def can_see(self, laser: str, entity: str) -> bool:
        """Returns whether the laser watches a layer of the entity."""
        return not set(self.watches.get(laser, ())).isdisjoint(self.layers_of(entity))

    @cached_property
    def _layers_by_entity(self) -> Mapping[str, tuple[str, ...]]:
        lists: dict[str, list[str]] = {}
        for layer in self.layers:
            for member in layer.members:
                lists.setdefault(member, []).append(layer.name)
        return {member: tuple(names) for member, names in lists.items()}


@dataclass(frozen=True, slots=True)
class RequirementBreach:
    """A requirement that an assignment violates."""

    requirement: Requirement
    is_missing: bool
    """True: it must happen and does not. False: it happens and must not."""
    layers: tuple[str, ...] = ()
    """The shared layers that make it happen."""

    def __str__(self) -> str:
        names = ", ".join(name.removeprefix("layer ") for name in self.layers)
        through = f" (layer {names})" if names else ""
        if isinstance(self.requirement, SightRequirement):
            verb = "must see" if self.is_missing else "must not see"
            return f"{self.requirement.laser} {verb} {self.requirement.entity}, but {'does not' if self.is_missing else 'does'}{through}"
        verb = "must" if self.is_missing else "must not"
        outcome = "share no layer" if self.is_missing else "share one"
        if self.requirement.a == self.requirement.b:
            return f"the copies of {self.requirement.a} {verb} collide, but {outcome}{through}"
        return f"{self.requirement.a} and {self.requirement.b} {verb} collide, but {outcome}{through}"


def find_breaches(case: LayerCase, assignment: LayerAssignment) -> tuple[RequirementBreach, ...]:
    """Everything in which the assignment differs from what the case asks; empty if it does just that."""
    found: list[RequirementBreach] = []
    lists = {name: set(assignment.layers_of(name)) for name in case.names}
    for pair in _pairs_in_question(case, assignment):
        shared = lists[pair.a] & lists[pair.b]
        relation = case.relation(pair.a, pair.b)
        if relation == "collide" and not shared:
            found.append(RequirementBreach(pair, is_missing=True))
        elif relation == "apart" and shared:
            found.append(RequirementBreach(pair, is_missing=False, layers=tuple(sorted(shared))))
    for laser in case.lasers:
        watched = set(assignment.watches.get(laser.name, ()))
        for name in case.names:
            shared = lists[name] & watched
            sighting = laser.sighting(name)
            if sighting == "sees" and not shared:
                found.append(RequirementBreach(SightRequirement(laser.name, name), is_missing=True))
            elif sighting == "blind" and shared:
                found.append(
                    RequirementBreach(
                        SightRequirement(laser.name, name), is_missing=False, layers=tuple(sorted(shared))
                    )
                )
    return tuple(found)


def _pairs_in_question(case: LayerCase, assignment: LayerAssignment) -> list[ContactRequirement]:
    """The pairs that must collide or that share a layer, in the order of the case; then each entity with itself."""
    order = {name: i for i, name in enumerate(case.names)}
    met = {contact for contact in case.collide if contact.a != contact.b}
    for layer in assignment.layers:
        members = sorted((name for name in layer.members if name in order), key=order.__getitem__)
        met.update(ContactRequirement(a, b) for a, b in combinations(members, 2))
    pairs = (sorted((pair.a, pair.b), key=order.__getitem__) for pair in met)
    return [
        *(
            ContactRequirement(a, b)
            for a, b in sorted(pairs, key=lambda pair: (order[pair[0]], order[pair[1]]))
        ),
        *(ContactRequirement(name, name) for name in case.names),
    ]


def drop_superfluous(
    case: LayerCase, layers: Sequence[frozenset[str]]
) -> tuple[list[frozenset[str]], dict[str, list[int]]]:
    """Layers without the members, and lasers without the layers, that nothing rests on.

    Takes layers that serve every requirement of the case when each laser watches all it may. Returns the
    layers with fewer members, and for each laser the numbers of those it has to watch. What is left out can
    only take away contacts and sightings that are not required.
    """
    watches = {laser.name: _choose_watched(case, laser.name, layers) for laser in case.lasers}
    members = [set(layer) for layer in layers]
    places: dict[str, set[int]] = defaultdict(set)
    for number, layer in enumerate(layers):
        for name in layer:
            places[name].add(number)
    needs = Counter(name for contact in case.collide for name in (contact.a, contact.b))
    for number, layer in enumerate(layers):
        for name in sorted(layer, key=lambda n: (needs[n], n)):
            if _is_superfluous(case, name, number, members[number], places, watches):
                members[number].discard(name)
                places[name].discard(number)
    return [frozenset(layer) for layer in members], watches


def name_layers(
    case: LayerCase, layers: Sequence[frozenset[str]], watches: Mapping[str, Iterable[int]]
) -> LayerAssignment:
    """The layers with the slides' names: C1, C2, ... where some contact rests on them, L1, L2, ... for lasers alone."""
    order = {name: i for i, name in enumerate(case.names)}
    kinds = ["C" if _has_contact(case, layer) else "L" for layer in layers]
    ranks = sorted(range(len(layers)), key=lambda i: (kinds[i], sorted(order[name] for name in layers[i])))
    names: dict[int, str] = {}
    counts: Counter[str] = Counter()
    for number in ranks:
        counts[kinds[number]] += 1
        names[number] = f"{kinds[number]}{counts[kinds[number]]}"
    watched = {laser: set(numbers) for laser, numbers in watches.items()}
    return LayerAssignment(
        tuple(NamedLayer(names[i], layers[i]) for i in ranks),
        {laser: tuple(names[i] for i in ranks if i in numbers) for laser, numbers in watched.items()},
    )


def _has_contact(case: LayerCase, layer: frozenset[str]) -> bool:
    return any(not case.must_meet[name].isdisjoint(layer) for name in layer)


def _choose_watched(case: LayerCase, laser: str, layers: Sequence[frozenset[str]]) -> list[int]:
    """Few layers that show the laser all it must see and nothing it must not: greedily, then the superfluous dropped."""
    sees, blind = case.laser[laser].sees, case.blind_set(case.laser[laser])
    usable = {i: layer & sees for i, layer in enumerate(layers) if layer.isdisjoint(blind) and layer & sees}
    chosen: list[int] = []
    left = set(sees)
    while left and (best := max(usable, key=lambda i: (len(usable[i] & left), -i), default=None)) is not None:
        if not usable[best] & left:
            break
        chosen.append(best)
        left -= usable[best]
    for number in list(chosen):
        if usable[number] <= frozenset().union(*(usable[i] for i in chosen if i != number)):
            chosen.remove(number)
    return sorted(chosen)


def _is_superfluous(
    case: LayerCase,
    name: str,
    number: int,
    members: Set[str],
    places: Mapping[str, set[int]],
    watches: Mapping[str, list[int]],
) -> bool:
    """Returns whether the entity can leave the layer and every requirement still be met.

    ``members``: of that layer. ``places``: the numbers of all layers that each entity is in.
    """
    elsewhere = places[name] - {number}
    for other in case.must_meet[name] & members:
        if not elsewhere if other == name else places[other].isdisjoint(elsewhere):
            return False
    return not any(
        number in watched and name in case.laser[laser].sees and elsewhere.isdisjoint(watched)
        for laser, watched in watches.items()
    )
