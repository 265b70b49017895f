"""A Flatland world as a case: today's collisions and sightings become the requirements.

"The same behaviour, with the fewest layers." Everything here is decided slot by slot (``slots``), because a slot
is what can be written. Where a slot stands for several model instances, it has to do right by all of them: two
slots must share a layer when any of their spots collide today, and must not when any of them could and do not.

Slots of the same instances are put together where one asks nothing that another does not ask as well: giving the
first the list of the second breaks nothing and costs nothing, so the optimum stays what it is, and the groups are
those a person would draw: a robot, or the parts of it that differ.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from itertools import combinations, product
from typing import TypeVar

from kit.layers.assignment import Assignment, Breach, NamedLayer
from kit.layers.reading import Requirements
from kit.layers.requirements import Case, CaseError, Contact, Entity, Laser, Relation, Sight, Sighting
from kit.layers.slots import LaserSlot, Slot, Slots, Spot
from kit.world.problems import Problem, WorldError
from kit.world.records import ALL_LAYERS, Place
from kit.world.records import Sight as View

T = TypeVar("T", Relation, Sighting)

PairWish = Callable[[Spot, Spot], Relation]
"""What is asked of two spots that can meet."""

ViewWish = Callable[[LaserSlot, tuple[str, View], Spot], Sighting]
"""What is asked of a laser of one model and a spot that it can see."""


@dataclass(frozen=True)
class WorldCase:
    """A case, and the lists in a world's files that its answer is written to."""

    slots: Slots
    case: Case
    entities: Mapping[str, tuple[Slot, ...]]
    """For every entity of the case, the lists that get its layers."""
    lasers: Mapping[str, LaserSlot]
    today: Assignment
    """What the files say now."""
    wrong: tuple[Breach, ...]
    """In which the files, list by list, differ from what is asked."""


def today_case(slots: Slots, *, grouped: bool = True) -> WorldCase:
    """What happens today is what shall happen. ``grouped``: as in ``case_of``."""
    return case_of(
        slots,
        lambda a, b: "collide" if a.category & b.category else "apart",
        lambda laser, use, spot: "sees" if use[1].bits & spot.category else "blind",
        title=f"{slots.world.file.parent.name}/{slots.world.file.name}",
        grouped=grouped,
    )


def case_of(
    slots: Slots, pair: PairWish, view: ViewWish, *, title: str = "", grouped: bool = True
) -> WorldCase:
    """The case in which wishes about spots have become relations of entities, each a group of slots.

    ``grouped``: slots with equal needs are one entity; otherwise each is one, which takes as many layers. Raises
    WorldError where a list would have to do two things at once.
    """
    table = _Table(slots, pair, view)
    asked = deepcopy(table.relation)
    groups = table.merged() if grouped else [[i] for i in range(len(table.rows))]
    names = _names(slots, groups)
    everything = [(name, group) for name, group in zip(names, groups, strict=True)]
    try:
        case = _case(slots, table, everything, title)
    except CaseError as error:
        raise WorldError([Problem(Place(slots.world.file), str(error))]) from error
    entities = {name: tuple(table.rows[i] for i in group) for name, group in everything}
    lasers = dict(zip((laser.name for laser in case.lasers), slots.lasers, strict=True))
    wrong = _wrong(slots, asked, table, everything, list(lasers))
    return WorldCase(slots, case, entities, lasers, _today(slots, entities, lasers), wrong)


def as_requirements(world_case: WorldCase) -> Requirements:
    """The case as requirements that can be written down, edited, and laid over the same world again."""
    slots, case = world_case.slots, world_case.case
    bodies = [entity for entity in case.entities if entity.kind == "bodies"]
    lists = world_case.entities
    return Requirements(
        slots.world.file,
        case,
        slots.world.file,
        {entity.model: lists[entity.name][0].models for entity in bodies},
        {
            entity.name: _bodies_meant(slots, [spot for slot in lists[entity.name] for spot in slot.spots])
            for entity in bodies
            if entity.name != entity.model
        },
    )


class _Table:
    """The relations of all slots, before any are put together. ``rows``: the maps, then the bodies."""

    def __init__(self, slots: Slots, pair: PairWish, view: ViewWish) -> None:
        self._slots, self._pair, self._view = slots, pair, view
        self.rows: tuple[Slot, ...] = (*slots.maps, *slots.bodies)
        count = len(self.rows)
        self.relation: list[list[Relation]] = [["either"] * count for _ in range(count)]
        for i in range(count):
            for j in range(i + 1):
                self.relation[i][j] = self.relation[j][i] = self._between(i, j)
        self.sighting: list[list[Sighting]] = [
            [self._seen(laser, slot) for slot in self.rows] for laser in slots.lasers
        ]

    def _between(self, i: int, j: int) -> Relation:
        a, b = self.rows[i], self.rows[j]
        if not a.models and not b.models:  # maps: each needs a name, and a name belongs to one of them
            return "collide" if i == j else "apart"
        pairs = combinations(a.spots, 2) if i == j else product(a.spots, b.spots)
        wishes = (
            (self._pair(p, q), f"{p.address} and {q.address}") for p, q in pairs if self._slots.can_meet(p, q)
        )
        return _agreed(wishes, "collide", "apart", a)

    def _seen(self, laser: LaserSlot, slot: Slot) -> Sighting:
        wishes = (
            (self._view(laser, use, spot), f"{use[0]}/{laser.plugin} and {spot.address}")
            for use, spot in product(laser.uses, slot.spots)
            if self._slots.can_see(use, spot)
        )
        return _agreed(wishes, "sees", "blind", slot)

    def merged(self) -> list[list[int]]:
        """The slots in groups of equal needs, first the neediest of each group."""
        groups = {i: [i] for i in range(len(self.rows))}
        absorbed = True
        while absorbed:
            absorbed = False
            for weak in sorted(groups, reverse=True):
                strong = next((i for i in groups if self._can_absorb(i, weak, groups)), None)
                if strong is not None:
                    self._join(strong, weak)
                    groups[strong] += groups.pop(weak)
                    absorbed = True
        return [sorted(group, key=lambda i: (i != head, i)) for head, group in groups.items()]

    def _join(self, strong: int, weak: int) -> None:
        """Makes the needs of ``strong`` those of both."""
        for relation in ("apart", "collide"):
            if relation in (self.relation[strong][weak], self.relation[weak][weak]):
                self.relation[strong][strong] = relation
        for w, relation in enumerate(self.relation[weak]):
            if relation == "apart" and w != strong:
                self.relation[strong][w] = self.relation[w][strong] = "apart"
        for seen in self.sighting:
            if seen[weak] == "blind":
                seen[strong] = "blind"

    def _can_absorb(self, strong: int, weak: int, groups: Mapping[int, list[int]]) -> bool:
        """Whether ``weak`` asks nothing that ``strong`` does not ask as well, and the two may be together."""
        if strong == weak or self.rows[strong].models != self.rows[weak].models or not self.rows[weak].models:
            return False
        if self._slots.kept_bits(self.rows[strong]) != self._slots.kept_bits(self.rows[weak]):
            return False
        if self._asks_nothing(strong) and self._asks_nothing(weak):
            return True  # both have an empty list, and keep it
        own, shared = self.relation[weak][weak], self.relation[strong][weak]
        if shared == "apart" or (
            own not in ("either", self.relation[strong][strong]) and shared != "collide"
        ):
            return False
        mine, its = self.relation[weak], self.relation[strong]
        return all(mine[w] in ("either", its[w]) for w in groups if w not in (strong, weak)) and all(
            seen[weak] in ("either", seen[strong]) for seen in self.sighting
        )

    def _asks_nothing(self, i: int) -> bool:
        if any(spot.category for spot in self.rows[i].spots):
            return False
        return "collide" not in self.relation[i] and all(seen[i] != "sees" for seen in self.sighting)


def _agreed(wishes: Iterator[tuple[T, str]], yes: T, no: T, slot: Slot) -> T:
    """What all wishes come to: yes or no, if any says so. Raises WorldError if some say the one and some the other."""
    said: dict[T, str] = {}
    for wish, who in wishes:
        said.setdefault(wish, who)
        if yes in said and no in said:
            words = {"collide": "collide", "sees": "meet the laser"}[yes]
            raise WorldError(
                [
                    Problem(
                        slot.place,
                        f"contradiction: {said[yes]} must {words}, {said[no]} must not, and one list of layers "
                        f"serves both. Give one of the models a file of its own",
                    )
                ]
            )
    if yes in said:
        return yes
    return no if no in said else "either"


def _case(slots: Slots, table: _Table, groups: list[tuple[str, list[int]]], title: str) -> Case:
    entities = tuple(
        Entity(
            name,
            kind="bodies" if table.rows[group[0]].models else "map",
            model=_owner(slots, table.rows[group[0]].models),
            copies=max(1, len(table.rows[group[0]].models)),
        )
        for name, group in groups
    )
    shared = {entity.name for entity in entities if entity.copies > 1}
    heads = [(name, group[0]) for name, group in groups]
    pairs = [((a, i), (b, j)) for k, (a, i) in enumerate(heads) for b, j in heads[k:]]
    relations = {Contact(a, b): table.relation[i][j] for (a, i), (b, j) in pairs}
    lasers = tuple(
        Laser(
            name,
            frozenset(entity for entity, i in heads if seen[i] == "sees"),
            frozenset(entity for entity, i in heads if seen[i] == "either"),
        )
        for name, seen in zip(_laser_names(slots), table.sighting, strict=True)
    )
    return Case(
        entities,
        tuple(contact for contact, relation in relations.items() if relation == "collide"),
        frozenset(
            contact
            for contact, relation in relations.items()
            if relation == "either" and (contact.a != contact.b or contact.a in shared)
        ),
        lasers,
        title,
    )


def _wrong(
    slots: Slots,
    asked: list[list[Relation]],
    table: _Table,
    groups: list[tuple[str, list[int]]],
    lasers: list[str],
) -> tuple[Breach, ...]:
    """Where the lists of today do not do what is asked of them, before any were put together."""
    name = {i: entity for entity, group in groups for i in group}
    bits = [slot.spots[0].category for slot in table.rows]
    found: dict[Breach, None] = {}
    for i in range(len(bits)):
        for j in range(i + 1):
            shared = bits[i] & bits[j]
            if asked[i][j] == ("apart" if shared else "collide"):
                contact = Contact(name[j], name[i])
                found[Breach(contact, wanted=not shared, layers=_layer_names(slots, shared))] = None
    for laser, seen, slot in zip(lasers, table.sighting, slots.lasers, strict=True):
        for i, sighting in enumerate(seen):
            shared = bits[i] & slot.uses[0][1].bits
            if sighting == ("blind" if shared else "sees"):
                sight = Sight(laser, name[i])
                found[Breach(sight, wanted=not shared, layers=_layer_names(slots, shared))] = None
    return tuple(found)


def _layer_names(slots: Slots, bits: int) -> tuple[str, ...]:
    return tuple(name for name, bit in slots.world.layer_bits.items() if bit & bits)


def _owner(slots: Slots, models: tuple[str, ...]) -> str:
    """What to call the instances that share a list: by name if it is one, else by their file."""
    if len(models) < 2:
        return models[0] if models else ""
    files = {model.file for model in slots.world.models if model.name in models}
    if len(files) > 1:
        return "+".join(models)
    stem = files.pop().name.removesuffix(".yaml").removesuffix(".model")
    return stem if all(model.name != stem for model in slots.world.models) else f"{stem}+"


def _names(slots: Slots, groups: list[list[int]]) -> list[str]:
    """A name for each group: the map's, the model's, or the model's and what of it is meant."""
    rows = (*slots.maps, *slots.bodies)
    names: list[str] = []
    for group in groups:
        spots = [spot for i in group for spot in rows[i].spots]
        if not spots[0].model:
            name = spots[0].thing.body
        else:
            owner = _owner(slots, rows[group[0]].models)
            part = _part(_bodies_meant(slots, spots))
            name = owner if _is_everything(slots, spots) else f"{owner}.{part}"
            if name == owner and name in names:  # a map is called so
                name += ".all"
        while name in names:
            name += "'"
        names.append(name)
    return names


def _is_everything(slots: Slots, spots: list[Spot]) -> bool:
    models = {spot.model for spot in spots}
    return sum(spot.model in models for slot in slots.bodies for spot in slot.spots) == len(spots)


def _part(bodies: tuple[str, ...]) -> str:
    """A short name for a few bodies."""
    return "+".join(bodies) if len(bodies) < 3 else f"{bodies[0]}+{len(bodies) - 1}"


def _bodies_meant(slots: Slots, spots: list[Spot]) -> tuple[str, ...]:
    """``body``, or ``body.0`` for the first footprint of a body that is not meant as a whole."""
    first = spots[0].model
    meant: list[str] = []
    for body in dict.fromkeys(spot.thing.body for spot in spots if spot.model == first):
        numbers = {spot.number for spot in spots if spot.model == first and spot.thing.body == body}
        has = {
            spot.number
            for slot in slots.bodies
            for spot in slot.spots
            if spot.model == first and spot.thing.body == body
        }
        meant += [body] if numbers == has else [f"{body}.{number}" for number in sorted(numbers)]
    return tuple(meant)


def _laser_names(slots: Slots) -> list[str]:
    names: list[str] = []
    for laser in slots.lasers:
        name = f"{_owner(slots, tuple(dict.fromkeys(model for model, _ in laser.uses)))}.{laser.plugin}"
        while name in names:
            name += "'"
        names.append(name)
    return names


def _today(
    slots: Slots, entities: Mapping[str, tuple[Slot, ...]], lasers: Mapping[str, LaserSlot]
) -> Assignment:
    """What the files say now, of every entity the first of its lists, which is the neediest.

    A world that names no layer can still have things in all of them: they meet in one called "all".
    """
    bits = dict(slots.world.layer_bits) or {"all": ALL_LAYERS}
    layers = []
    for name, bit in bits.items():
        members = [entity for entity, lists in entities.items() if lists[0].spots[0].category & bit]
        layers.append(NamedLayer(name, frozenset(members)))
    watches = {
        name: tuple(layer for layer, bit in bits.items() if laser.uses[0][1].bits & bit)
        for name, laser in lasers.items()
    }
    return Assignment(tuple(layers), watches)
