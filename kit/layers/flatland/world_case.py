"""A Flatland world as a case: today's collisions and sightings become the requirements.

"The same behaviour, with the fewest layers." Everything here is decided list by list (``layer_lists``), because a
list is what can be written. A list of several model instances has to serve all of them: two lists must share a
layer when any of their uses collide at present, and must not when any of them could and do not.

Layer lists of the same model instances are merged where one requires nothing that another does not require as well: giving
the first the list of the second breaks nothing and costs nothing, so the optimum stays what it is, and the groups
are those a person would draw: a robot, or the parts of it that differ.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from copy import deepcopy
from dataclasses import dataclass
from itertools import combinations, product
from typing import Final, TypeVar

from kit.layers.assignment import LayerAssignment, NamedLayer, RequirementBreach
from kit.layers.flatland.layer_lists import FootprintUse, LaserLayerList, LayerList, LayerLists
from kit.layers.requirements import (
    ContactRequirement,
    LaserEntity,
    LayerCase,
    LayerCaseError,
    LayerEntity,
    Relation,
    Sighting,
    SightRequirement,
)
from kit.layers.requirements_file import RequirementsFile
from kit.world.problems import Problem, WorldError
from kit.world.records import ALL_LAYERS, SourceLocation
from kit.world.records import LaserMount as View

T = TypeVar("T", Relation, Sighting)
L = TypeVar("L", str, FootprintUse)

PairRelation = Callable[[FootprintUse, FootprintUse], Relation]
"""Returns the required relation of two uses that can collide."""

LaserRelation = Callable[[LaserLayerList, tuple[str, View], FootprintUse], Sighting]
"""Returns the required relation of a laser of one model and a use that it can see."""


class RelationTable:
    """The relations of all layer lists, before any are merged. ``rows``: the maps, then the bodies."""

    def __init__(self, layer_lists: LayerLists, pair: PairRelation, view: LaserRelation) -> None:
        self._layer_lists, self._relation_of_pair, self._relation_of_laser = layer_lists, pair, view
        self.rows: tuple[LayerList, ...] = (*layer_lists.maps, *layer_lists.bodies)
        count = len(self.rows)
        self.relation: list[list[Relation]] = [["either"] * count for _ in range(count)]
        for i in range(count):
            for j in range(i + 1):
                self.relation[i][j] = self.relation[j][i] = self._pair_relation(i, j)
        self.sighting: list[list[Sighting]] = [
            [self._laser_relation(laser, layer_list) for layer_list in self.rows]
            for laser in layer_lists.lasers
        ]

    def _pair_relation(self, i: int, j: int) -> Relation:
        a, b = self.rows[i], self.rows[j]
        if not a.models and not b.models:  # maps: each needs a name, and a name belongs to one of them
            return "collide" if i == j else "apart"
        pairs = combinations(a.uses, 2) if i == j else product(a.uses, b.uses)
        relations = (
            (self._relation_of_pair(p, q), p, q) for p, q in pairs if self._layer_lists.can_collide(p, q)
        )
        return _combine_relations(
            "either",
            relations,
            lambda p, q, relation: f"{p.address} {_MODAL_VERBS[relation]} collide with {q.address}",
            a,
        )

    def _laser_relation(self, laser: LaserLayerList, layer_list: LayerList) -> Sighting:
        relations = (
            (self._relation_of_laser(laser, laser_use, use), laser_use[0], use)
            for laser_use, use in product(laser.uses, layer_list.uses)
            if self._layer_lists.can_see(laser_use, use)
        )
        return _combine_relations(
            "either",
            relations,
            lambda model, use, relation: f"{model}/{laser.plugin} {_MODAL_VERBS[relation]} see {use.address}",
            layer_list,
        )

    def merge_lists(self) -> list[list[int]]:
        """Returns the lists in groups of equal needs, the neediest of each group first."""
        groups = {i: [i] for i in range(len(self.rows))}
        families: defaultdict[tuple[object, int], list[int]] = defaultdict(list)
        for i, layer_list in enumerate(self.rows):
            if models := layer_list.models:
                families[models, self._layer_lists.kept_bits(layer_list)].append(i)
        for family in families.values():
            while pair := self._mergeable_pair(family, groups):
                strong, weak = pair
                self._merge_needs(strong, weak)
                groups[strong] += groups.pop(weak)
                family.remove(weak)
        return [sorted(group, key=lambda i: (i != head, i)) for head, group in groups.items()]

    def _mergeable_pair(self, family: list[int], groups: Mapping[int, list[int]]) -> tuple[int, int] | None:
        """Two of the family of which the first can absorb the second."""
        pairs = ((strong, weak) for weak in reversed(family) for strong in family if strong != weak)
        return next((pair for pair in pairs if self._can_absorb(*pair, groups)), None)

    def _merge_needs(self, strong: int, weak: int) -> None:
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
        """Returns whether ``weak`` asks nothing that ``strong`` does not ask as well, and the two may be together."""
        if self._has_no_needs(strong) and self._has_no_needs(weak):
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

    def _has_no_needs(self, i: int) -> bool:
        if any(use.category for use in self.rows[i].uses):
            return False
        return "collide" not in self.relation[i] and all(seen[i] != "sees" for seen in self.sighting)


_MODAL_VERBS: Final[Mapping[Relation | Sighting, str]] = {
    "collide": "must",
    "apart": "must not",
    "sees": "must",
    "blind": "must not",
    "either": "may",
}


def _combine_relations(
    open_: T,
    relations: Iterable[tuple[T, L, FootprintUse]],
    in_words: Callable[[L, FootprintUse, T], str],
    layer_list: LayerList,
) -> T:
    """Combines the relations required of one list: yes or no, if any is required. Raises WorldError if both are."""
    stated: dict[T, tuple[L, FootprintUse]] = {}
    for relation, who, use in relations:
        if relation != open_:
            stated.setdefault(relation, (who, use))
    if len(stated) > 1:
        words = ", and ".join(in_words(*who, relation) for relation, who in stated.items())
        problem = (
            f"contradiction: {words}, but one list of layers serves both: give one of them a file of its own"
        )
        raise WorldError([Problem(layer_list.location, problem)])
    return next(iter(stated), open_)


@dataclass(frozen=True)
class WorldCase:
    """A case, and the lists in a world's files that its answer is written to."""

    layer_lists: LayerLists
    case: LayerCase
    entities: Mapping[str, tuple[LayerList, ...]]
    """For every entity of the case, the lists that get its layers."""
    lasers: Mapping[str, LaserLayerList]
    current_assignment: LayerAssignment
    """What the files say now."""
    current_breaches: tuple[RequirementBreach, ...]
    """Where the files, list by list, do not meet the requirements."""


def current_case(layer_lists: LayerLists, *, grouped: bool = True) -> WorldCase:
    """Builds the case that requires the world's present behaviour. ``grouped``: as in ``build_case``."""
    return build_case(
        layer_lists,
        lambda a, b: "collide" if a.category & b.category else "apart",
        lambda laser, laser_use, use: "sees" if laser_use[1].bits & use.category else "blind",
        title=f"{layer_lists.world.file.absolute().parent.name}/{layer_lists.world.file.name}",
        grouped=grouped,
    )


def build_case(
    layer_lists: LayerLists, pair: PairRelation, view: LaserRelation, *, title: str = "", grouped: bool = True
) -> WorldCase:
    """Builds the case whose entities are groups of layer lists, from the relations of footprint uses.

    ``grouped``: lists with equal needs are one entity; otherwise each is one, which takes as many layers. Raises
    WorldError where a list would have to do two things at once.
    """
    table = RelationTable(layer_lists, pair, view)
    asked = deepcopy(table.relation)
    groups = table.merge_lists() if grouped else [[i] for i in range(len(table.rows))]
    names = _group_names(layer_lists, groups)
    everything = [(name, group) for name, group in zip(names, groups, strict=True)]
    try:
        case = _merged_case(layer_lists, table, everything, title)
    except LayerCaseError as error:
        raise WorldError([Problem(SourceLocation(layer_lists.world.file), str(error))]) from error
    entities = {name: tuple(table.rows[i] for i in group) for name, group in everything}
    lasers = dict(zip((laser.name for laser in case.lasers), layer_lists.lasers, strict=True))
    wrong = _current_breaches(layer_lists, asked, table, everything, list(lasers))
    return WorldCase(
        layer_lists, case, entities, lasers, _current_assignment(layer_lists, entities, lasers), wrong
    )


def to_requirements_file(world_case: WorldCase) -> RequirementsFile:
    """The case as requirements that can be written down, edited, and laid over the same world again."""
    layer_lists, case = world_case.layer_lists, world_case.case
    bodies = [entity for entity in case.entities if entity.kind == "bodies"]
    lists = world_case.entities
    return RequirementsFile(
        layer_lists.world.file,
        case,
        layer_lists.world.file,
        {entity.model: lists[entity.name][0].models for entity in bodies},
        {
            entity.name: _body_names(
                layer_lists, [use for layer_list in lists[entity.name] for use in layer_list.uses]
            )
            for entity in bodies
            if entity.name != entity.model
        },
    )


def _merged_case(
    layer_lists: LayerLists, table: RelationTable, groups: list[tuple[str, list[int]]], title: str
) -> LayerCase:
    entities = tuple(
        LayerEntity(
            name,
            kind="bodies" if table.rows[group[0]].models else "map",
            model=_owner_name(layer_lists, table.rows[group[0]].models),
            copies=max(1, len(table.rows[group[0]].models)),
        )
        for name, group in groups
    )
    shared = {entity.name for entity in entities if entity.copies > 1}
    heads = [(name, group[0]) for name, group in groups]
    pairs = [((a, i), (b, j)) for k, (a, i) in enumerate(heads) for b, j in heads[k:]]
    relations = {ContactRequirement(a, b): table.relation[i][j] for (a, i), (b, j) in pairs}
    lasers = tuple(
        LaserEntity(
            name,
            frozenset(entity for entity, i in heads if seen[i] == "sees"),
            frozenset(entity for entity, i in heads if seen[i] == "either"),
        )
        for name, seen in zip(_laser_names(layer_lists), table.sighting, strict=True)
    )
    return LayerCase(
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


def _current_breaches(
    layer_lists: LayerLists,
    asked: list[list[Relation]],
    table: RelationTable,
    groups: list[tuple[str, list[int]]],
    lasers: list[str],
) -> tuple[RequirementBreach, ...]:
    """Returns the requirements that the present lists violate, before any were merged."""
    name = {i: entity for entity, group in groups for i in group}
    bits = [layer_list.uses[0].category for layer_list in table.rows]
    found: dict[RequirementBreach, None] = {}
    for i in range(len(bits)):
        for j in range(i + 1):
            shared = bits[i] & bits[j]
            if asked[i][j] == ("apart" if shared else "collide"):
                contact = ContactRequirement(name[j], name[i])
                found[
                    RequirementBreach(
                        contact, is_missing=not shared, layers=_layer_names(layer_lists, shared)
                    )
                ] = None
    for laser, seen, layer_list in zip(lasers, table.sighting, layer_lists.lasers, strict=True):
        for i, sighting in enumerate(seen):
            shared = bits[i] & layer_list.uses[0][1].bits
            if sighting == ("blind" if shared else "sees"):
                sight = SightRequirement(laser, name[i])
                found[
                    RequirementBreach(sight, is_missing=not shared, layers=_layer_names(layer_lists, shared))
                ] = None
    return tuple(found)


def _layer_names(layer_lists: LayerLists, bits: int) -> tuple[str, ...]:
    return tuple(name for name, bit in layer_lists.world.layer_bits.items() if bit & bits)


def _owner_name(layer_lists: LayerLists, models: tuple[str, ...]) -> str:
    """Returns a name for the instances that share a list: the instance's if it is one, else that of their file."""
    if len(models) < 2:
        return models[0] if models else ""
    files = {model.file for model in layer_lists.world.models if model.name in models}
    if len(files) > 1:
        return "+".join(models)
    stem = files.pop().name.removesuffix(".yaml").removesuffix(".model")
    return stem if all(model.name != stem for model in layer_lists.world.models) else f"{stem}+"


def _group_names(layer_lists: LayerLists, groups: list[list[int]]) -> list[str]:
    """A name for each group: the map's, the model's, or the model's and what of it is meant."""
    rows = (*layer_lists.maps, *layer_lists.bodies)
    names: list[str] = []
    for group in groups:
        uses = [use for i in group for use in rows[i].uses]
        if not uses[0].model:
            name = uses[0].body.body
        else:
            owner = _owner_name(layer_lists, rows[group[0]].models)
            part = _bodies_label(_body_names(layer_lists, uses))
            name = owner if _is_everything(layer_lists, uses) else f"{owner}.{part}"
            if name == owner and name in names:  # a map is called so
                name += ".all"
        while name in names:
            name += "'"
        names.append(name)
    return names


def _is_everything(layer_lists: LayerLists, uses: list[FootprintUse]) -> bool:
    models = {use.model for use in uses}
    return sum(use.model in models for layer_list in layer_lists.bodies for use in layer_list.uses) == len(
        uses
    )


def _bodies_label(bodies: tuple[str, ...]) -> str:
    """A short name for a few bodies."""
    return "+".join(bodies) if len(bodies) < 3 else f"{bodies[0]}+{len(bodies) - 1}"


def _body_names(layer_lists: LayerLists, uses: list[FootprintUse]) -> tuple[str, ...]:
    """``body``, or ``body.0`` for the first footprint of a body that is not meant as a whole."""
    first = uses[0].model
    meant: list[str] = []
    for body in dict.fromkeys(use.body.body for use in uses if use.model == first):
        numbers = {use.number for use in uses if use.model == first and use.body.body == body}
        has = {
            use.number
            for layer_list in layer_lists.bodies
            for use in layer_list.uses
            if use.model == first and use.body.body == body
        }
        meant += [body] if numbers == has else [f"{body}.{number}" for number in sorted(numbers)]
    return tuple(meant)


def _laser_names(layer_lists: LayerLists) -> list[str]:
    names: list[str] = []
    for laser in layer_lists.lasers:
        name = f"{_owner_name(layer_lists, tuple(dict.fromkeys(model for model, _ in laser.uses)))}.{laser.plugin}"
        while name in names:
            name += "'"
        names.append(name)
    return names


def _current_assignment(
    layer_lists: LayerLists,
    entities: Mapping[str, tuple[LayerList, ...]],
    lasers: Mapping[str, LaserLayerList],
) -> LayerAssignment:
    """Returns the present assignment: of every entity the first of its lists, which is the neediest.

    A world that names no layer can still have things in all of them: they meet in one called "all".
    """
    bits = dict(layer_lists.world.layer_bits) or {"all": ALL_LAYERS}
    layers = []
    for name, bit in bits.items():
        members = [entity for entity, lists in entities.items() if lists[0].uses[0].category & bit]
        layers.append(NamedLayer(name, frozenset(members)))
    watches = {
        name: tuple(layer for layer, bit in bits.items() if laser.uses[0][1].bits & bit)
        for name, laser in lasers.items()
    }
    return LayerAssignment(tuple(layers), watches)
