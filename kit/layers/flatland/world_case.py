"""A Flatland world as a case: today's collisions and sightings become the requirements.

"The same behaviour, with the fewest layers." Everything here is decided list by list (``layer_lists``), because a
list is what can be written. A list of several model instances has to serve all of them: two lists must share a
layer when any of their uses collide at present, and must not when any of them could and do not.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass

from kit.layers.assignment import LayerAssignment, NamedLayer, RequirementBreach
from kit.layers.flatland.grouping import LaserRelation, PairRelation, RelationTable
from kit.layers.flatland.layer_lists import FootprintUse, LaserLayerList, LayerList, LayerLists
from kit.layers.requirements import (
    ContactRequirement,
    LaserEntity,
    LayerCase,
    LayerCaseError,
    LayerEntity,
    Relation,
    SightRequirement,
)
from kit.layers.requirements_file import RequirementsFile
from kit.world.problems import Problem, WorldError
from kit.world.records import ALL_LAYERS, SourceLocation


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
    """In which the files, list by list, differ from what is asked."""


def current_case(layer_lists: LayerLists, *, grouped: bool = True) -> WorldCase:
    """Builds the case that requires the world's present behaviour. ``grouped``: as in ``build_case``."""
    return build_case(
        layer_lists,
        lambda a, b: "collide" if a.category & b.category else "apart",
        lambda laser, laser_use, use: "sees" if laser_use[1].bits & use.category else "blind",
        title=f"{layer_lists.world.file.parent.name}/{layer_lists.world.file.name}",
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
