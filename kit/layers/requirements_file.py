"""Requirements written down: a small YAML file, read with every mistake at its place, and written.

    world: yard.world.yaml                 # optional: the Flatland world these are for
    maps: [hall, yard]
    models: [robot, crane, chair]
    parts: {crane: [hook, base]}           # of one model, with different needs: crane.hook, crane.base
    bodies: {crane.base: [base, wheel]}    # optional: which bodies are meant; otherwise the one of that name
    copies: {chair: [chair1, chair2]}      # model instances of one model file, which share one list of layers
    ghosts: [crane.hook]                   # never collide (collision: false); lasers may see them
    collide:                               # who must collide with whom
      robot: [hall, crane, chair]
      chair: [chair]                       # its copies, or its bodies, among themselves
    either: {chair: [hall]}                # may share a layer or not
    lasers: {robot.front: [hall, chair]}   # what each laser must see
    may_see: {robot.front: [crane.hook]}   # what it may see

A pair that is not named must not collide, and what a laser is not to see it must not see; ``apart`` and
``blind`` say so in so many words, and are checked against the rest. A model's name stands for all its parts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations_with_replacement, groupby
from pathlib import Path
from types import MappingProxyType
from typing import Final

from kit.layers.flatland.yaml_scalars import format_flow_list, format_scalar
from kit.layers.requirements import (
    ContactRequirement,
    LaserEntity,
    LayerCase,
    LayerCaseError,
    LayerEntity,
    Relation,
    Requirement,
    Sighting,
    SightRequirement,
)
from kit.plain_text import quoted, suggestion
from kit.world.documents import open_document
from kit.world.problems import Problem, WorldError
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section

_RELATION_KEYS: Final[Mapping[str, Relation]] = MappingProxyType(
    {"collide": "collide", "either": "either", "apart": "apart"}
)
_SIGHTING_KEYS: Final[Mapping[str, Sighting]] = MappingProxyType(
    {"lasers": "sees", "may_see": "either", "blind": "blind"}
)
KEYS: Final = (
    "world",
    "maps",
    "models",
    "parts",
    "bodies",
    "copies",
    "ghosts",
    *_RELATION_KEYS,
    *_SIGHTING_KEYS,
)


@dataclass(frozen=True)
class RequirementsFile:
    """A requirements file: the case, and what its names mean in a Flatland world."""

    file: Path
    case: LayerCase
    world: Path | None
    copies: Mapping[str, tuple[str, ...]]
    """For each model of the case, the model instances of the world it stands for: itself, if nothing else is said."""
    bodies: Mapping[str, tuple[str, ...]]
    """For each part of a model, the bodies it consists of (``body``, or ``body.0`` for its first footprint)."""
    locations: Mapping[Requirement, SourceLocation] = field(default_factory=dict)
    """The location in the file of each requirement it states."""


@dataclass(frozen=True, slots=True)
class DeclaredNames:
    """The names a file declares: entities, and what stands for several of them."""

    entities: Mapping[str, LayerEntity]
    models: Mapping[str, tuple[str, ...]]

    def resolve(self, name: str, section: Section, key: str) -> tuple[str, ...]:
        """The entities a name stands for; none if it is unknown, which is noted."""
        if name in self.models:
            return self.models[name]
        if name in self.entities:
            return (name,)
        known = [*self.models, *self.entities]
        section.error(f"nothing here is called {quoted(name)}: {suggestion(name, known)}", key)
        return ()


def read_requirements(path: Path) -> RequirementsFile:
    """Reads a requirements file. Raises WorldError with all mistakes in it."""
    locations: dict[Requirement, SourceLocation] = {}
    with open_document(path) as section:
        title = section.text("title", "")
        world = section.name("world", "") if section.has("world") else ""
        copies, bodies = _read_name_lists(section, "copies"), _read_name_lists(section, "bodies")
        names = _read_names(section, copies)
        contacts = _read_contacts(section, names, locations)
        lasers = tuple(_read_lasers(section, names, locations))
        _check_known_keys(section, "copies", copies, names.models, "model")
        _check_known_keys(section, "bodies", bodies, names.entities, "part of a model")
    try:
        case = LayerCase(
            tuple(names.entities.values()),
            tuple(contact for contact, relation in contacts.items() if relation == "collide"),
            frozenset(contact for contact, relation in contacts.items() if relation == "either"),
            lasers,
            title,
        )
    except LayerCaseError as error:
        raise WorldError([Problem(SourceLocation(path), str(error))]) from error
    named = {model: copies.get(model, (model,)) for model in names.models}
    return RequirementsFile(path, case, path.parent / world if world else None, named, bodies, locations)


def _read_name_lists(section: Section, key: str) -> dict[str, tuple[str, ...]]:
    """A mapping from names to lists of names; empty where the key is missing."""
    inner = section.section(key, None)
    return {} if inner is None else {name: inner.texts(name) for name in inner.keys()}  # noqa: SIM118 - a Section


def _read_names(section: Section, copies: Mapping[str, tuple[str, ...]]) -> DeclaredNames:
    maps, models = section.texts("maps", ()), section.texts("models", ())
    for key, listed in (("maps", maps), ("models", models)):
        for name in dict.fromkeys(name for name in listed if listed.count(name) > 1):
            section.error(f"{quoted(name)} is named twice", key)
    parts = _read_name_lists(section, "parts")
    _check_known_keys(section, "parts", parts, models, "model")
    grouped = {
        model: tuple(f"{model}.{part}" for part in parts.get(model, ())) or (model,) for model in models
    }
    entities: dict[str, LayerEntity] = {}
    for key, kind_entities in (
        ("maps", [LayerEntity(name, kind="map") for name in maps]),
        (
            "models",
            [
                LayerEntity(name, model=model, copies=len(copies.get(model, (model,))))
                for model, names in grouped.items()
                for name in names
            ],
        ),
    ):
        for entity in kind_entities:
            if entity.name in entities:
                section.error(f"{quoted(entity.name)} is named twice", key)
            entities[entity.name] = entity
    names = DeclaredNames(entities, grouped)
    for ghost in [n for name in section.texts("ghosts", ()) for n in names.resolve(name, section, "ghosts")]:
        old = entities[ghost]
        entities[ghost] = LayerEntity(old.name, old.kind, old.model, old.copies, is_ghost=True)
    return names


def _check_known_keys(
    section: Section, key: str, found: Iterable[str], known: Iterable[str], what: str
) -> None:
    known = list(known)
    for name in found:
        if name not in known:
            section.error(f"{quoted(name)} is no {what}: {suggestion(name, known)}", key)


def _read_contacts(
    section: Section, names: DeclaredNames, locations: dict[Requirement, SourceLocation]
) -> dict[ContactRequirement, Relation]:
    """Every pair the file speaks of. Two statements about one pair that differ are noted, with both places."""
    statements: dict[ContactRequirement, tuple[Relation, SourceLocation]] = {}
    for key, relation in _RELATION_KEYS.items():
        inner = section.section(key, None)
        for name in () if inner is None else inner.keys():
            assert inner is not None
            first = names.resolve(name, inner, name)
            for other in inner.texts(name):
                for contact in _expand_pairs(first, names.resolve(other, inner, name), names):
                    if reason := _impossible_reason(contact, relation, names):
                        inner.error(reason, name)
                        continue
                    earlier, location = statements.setdefault(contact, (relation, inner.location_of(name)))
                    if earlier != relation:
                        inner.error(
                            _contradiction_text(
                                str(contact), _RELATION_TEXTS[relation], _RELATION_TEXTS[earlier], location
                            ),
                            name,
                        )
    locations.update({contact: location for contact, (_, location) in statements.items()})
    return {contact: relation for contact, (relation, _) in statements.items()}


def _expand_pairs(
    first: tuple[str, ...], second: tuple[str, ...], names: DeclaredNames
) -> Iterator[ContactRequirement]:
    """Each of one with each of the other. Of a model with itself: its parts with one another, and its copies."""
    if first == second and len(first) > 1:
        pairs = combinations_with_replacement(first, 2)
        yield from (ContactRequirement(a, b) for a, b in pairs if a != b or names.entities[a].copies > 1)
    else:
        yield from (ContactRequirement(a, b) for a in first for b in second)


def _impossible_reason(contact: ContactRequirement, relation: Relation, names: DeclaredNames) -> str | None:
    """Explains why Flatland rules a relation out; None if it does not."""
    a, b = names.entities[contact.a], names.entities[contact.b]
    if a == b and a.kind == "map":
        return f"{a.name} is a map: it cannot collide with itself"
    if a.kind == b.kind == "map" and relation != "apart":
        return (
            f"{a.name} and {b.name} are maps: maps never collide, and a layer name belongs to one entry of the "
            "world file, so no layer holds two"
        )
    if relation == "collide" and (a.is_ghost or b.is_ghost):
        return f"{(a if a.is_ghost else b).name} is one of the ghosts: it cannot collide with anything"
    return None


def _read_lasers(
    section: Section, names: DeclaredNames, locations: dict[Requirement, SourceLocation]
) -> Iterator[LaserEntity]:
    """Every laser with what the file says of it. Statements that contradict each other are noted."""
    sees_lists = _read_name_lists(section, "lasers")
    statements: dict[SightRequirement, tuple[Sighting, SourceLocation]] = {}
    for key, sighting in _SIGHTING_KEYS.items():
        inner = section.section(key, None)
        for laser in () if inner is None else inner.keys():
            assert inner is not None
            if laser not in sees_lists:
                inner.error(
                    f"there is no laser {quoted(laser)} under lasers: {suggestion(laser, sees_lists)}", laser
                )
            for sight in (
                SightRequirement(laser, e) for n in inner.texts(laser) for e in names.resolve(n, inner, laser)
            ):
                earlier, location = statements.setdefault(sight, (sighting, inner.location_of(laser)))
                if earlier != sighting:
                    inner.error(
                        _contradiction_text(
                            str(sight), _RELATION_TEXTS[sighting], _RELATION_TEXTS[earlier], location
                        ),
                        laser,
                    )
    locations.update({sight: location for sight, (_, location) in statements.items()})
    for laser in sees_lists:
        entities = {
            wanted: frozenset(
                sight.entity
                for sight, (stated, _) in statements.items()
                if sight.laser == laser and stated == wanted
            )
            for wanted in ("sees", "either")
        }
        yield LaserEntity(laser, entities["sees"], entities["either"])


_RELATION_TEXTS: Final = MappingProxyType(
    {
        "collide": "must collide",
        "either": "is left open",
        "apart": "must not collide",
        "sees": "must be seen",
        "blind": "must not be seen",
    }
)


def _contradiction_text(what: str, here: str, there: str, location: SourceLocation) -> str:
    return f"contradiction: {what} {here} here, and {there} in line {location.line}: strike one of the two"


# Writing


def requirements_text(case: LayerCase, *, requirements: RequirementsFile | None = None) -> str:
    """Returns the case as the text of a requirements file, which reads as the same case.

    ``requirements``: the file whose world, copies and bodies are written too.
    """
    lines = [f"title: {format_scalar(case.title)}"] if case.title else []
    if requirements is not None and requirements.world is not None:
        lines.append(f"world: {format_scalar(str(requirements.world))}")
    lines += _entity_lines(case, requirements)
    maps = {entity.name for entity in case.entities if entity.kind == "map"}
    lines += _mapping_lines(
        "collide", _adjacency_lists(c for c in case.collide if c.a != c.b or c.a not in maps)
    )
    lines += _mapping_lines("either", _adjacency_lists(sorted(case.either)))
    lines += _laser_lines(case)
    return "\n".join([*lines, ""])


def _entity_lines(case: LayerCase, requirements: RequirementsFile | None) -> list[str]:
    """Returns the lines that declare the entities: maps, models, parts, bodies, copies and ghosts."""
    maps = [entity.name for entity in case.entities if entity.kind == "map"]
    parts: dict[str, list[str]] = {}
    for entity in case.entities:
        if entity.kind != "map":
            names = parts.setdefault(entity.model or entity.name, [])
            if entity.model and entity.name != entity.model:
                names.append(entity.name.removeprefix(f"{entity.model}."))
    lines = [
        f"{key}: {format_flow_list(names)}" for key, names in (("maps", maps), ("models", parts)) if names
    ]
    lines += _mapping_lines("parts", {model: names for model, names in parts.items() if names})
    if requirements is not None:
        lines += _mapping_lines("bodies", requirements.bodies)
        copies = {model: names for model, names in requirements.copies.items() if names != (model,)}
        lines += _mapping_lines("copies", copies)
    if ghosts := [entity.name for entity in case.entities if entity.is_ghost]:
        lines.append(f"ghosts: {format_flow_list(ghosts)}")
    return lines


def _laser_lines(case: LayerCase) -> list[str]:
    """Returns the lines that say what each laser must see and may see."""
    sees = {laser.name: [name for name in case.names if name in laser.sees] for laser in case.lasers}
    may_see = {laser.name: [name for name in case.names if name in laser.either] for laser in case.lasers}
    may_see = {laser: names for laser, names in may_see.items() if names}
    return [*_mapping_lines("lasers", sees), *_mapping_lines("may_see", may_see)]


def _adjacency_lists(contacts: Iterable[ContactRequirement]) -> dict[str, list[str]]:
    """Pairs as a list for each first name. The order of the pairs is kept as far as such lists allow."""
    lists: dict[str, list[str]] = {}
    for first, run in groupby(contacts, key=lambda contact: contact.a):
        lists.setdefault(first, []).extend(contact.b for contact in run)
    return lists


def _mapping_lines(key: str, lists: Mapping[str, Iterable[str]]) -> list[str]:
    return (
        [f"{key}:", *(f"  {format_scalar(name)}: {format_flow_list(names)}" for name, names in lists.items())]
        if lists
        else []
    )


def is_world_file(path: Path) -> bool:
    """Returns whether a file is a Flatland world rather than requirements, told by its keys. Raises WorldError."""
    with open_document(path, is_partial=True) as section:
        keys = set(section.keys())
    return bool(keys & {"properties", "layers", "plugins"}) and not keys & {
        *_RELATION_KEYS,
        *_SIGHTING_KEYS,
        "maps",
        "world",
    }
