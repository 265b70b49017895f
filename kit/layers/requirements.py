"""The requirements of a layer plan: which entities must collide, and what each laser must see.

An *entity* is a map, a model, or a group of bodies of one model with the same needs: whatever gets one list
of layers. Two entities collide when they share a layer, and a laser sees an entity when it watches a layer
the entity is in (Flatland compares bit sets; nothing else enters). So every pair of entities is in one of
three relations, and every laser in one of three relations to every entity:

    pair    collide   some layer holds both          laser   sees     watches some layer of the entity
            either    either is fine                         either   either is fine
            apart     no layer holds both                    blind    watches no layer of the entity

What a case does not mention is ``apart``, and ``blind``: nothing happens that is not required.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from typing import Literal, TypeAlias

Relation = Literal["collide", "either", "apart"]
Sighting = Literal["sees", "either", "blind"]


@dataclass(frozen=True, slots=True)
class LayerEntity:
    """Whatever gets one list of layers."""

    name: str
    kind: Literal["map", "bodies"] = "bodies"
    model: str = ""
    """The model whose bodies these are: entities of one model have the same word here. Empty for a map."""
    copies: int = 1
    """Number of model instances that share this list, because they are read from one model file."""
    is_ghost: bool = False
    """Never collides (``collision: false``), whatever layers it shares; lasers can still see it."""


@dataclass(frozen=True, slots=True, eq=False)
class ContactRequirement:
    """A pair of entities; ``Contact(a, b) == Contact(b, a)``. ``Contact(a, a)``: the copies of ``a``, or its bodies,
    among themselves."""

    a: str
    b: str

    @property
    def _sorted_pair(self) -> tuple[str, str]:
        return (self.a, self.b) if self.a <= self.b else (self.b, self.a)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ContactRequirement) and self._sorted_pair == other._sorted_pair

    def __hash__(self) -> int:
        return hash(self._sorted_pair)

    def __lt__(self, other: ContactRequirement) -> bool:
        return self._sorted_pair < other._sorted_pair

    def __str__(self) -> str:
        return f"{self.a} - {self.b}"


@dataclass(frozen=True, slots=True, order=True)
class SightRequirement:
    """A laser and an entity that it must see, or must not."""

    laser: str
    entity: str

    def __str__(self) -> str:
        return f"{self.laser} > {self.entity}"


Requirement: TypeAlias = ContactRequirement | SightRequirement
"""Something some layer has to bring about: a contact, or a sighting."""


@dataclass(frozen=True, slots=True)
class LaserEntity:
    """The entities that a laser must see and may see; it must not see any other."""

    name: str
    sees: frozenset[str] = frozenset()
    either: frozenset[str] = frozenset()

    def sighting(self, entity: str) -> Sighting:
        if entity in self.sees:
            return "sees"
        return "either" if entity in self.either else "blind"


class LayerCaseError(ValueError):
    """A case that means nothing: a name given twice or unknown, a relation that Flatland rules out."""


@dataclass(frozen=True)
class LayerCase:
    """One layer-assignment problem. Immutable; the ``with_`` methods return the changed case.

    ``collide`` keeps the order it was written in, which is the order of the slides' list of edges. Raises
    CaseError for unknown or repeated names, for a pair that is both ``collide`` and ``either``, for two maps
    that shall share a layer (a layer name belongs to one entry of the world file) and for a ghost that shall
    collide.
    """

    entities: tuple[LayerEntity, ...]
    collide: tuple[ContactRequirement, ...] = ()
    either: frozenset[ContactRequirement] = frozenset()
    lasers: tuple[LaserEntity, ...] = ()
    title: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        _check_unique("entity", [entity.name for entity in self.entities])
        _check_unique("laser", [laser.name for laser in self.lasers])
        if len(self.required_contacts) < len(self.collide):
            raise LayerCaseError("the same pair is required twice")
        for contact in (*self.collide, *self.either):
            self._check_contact(contact)
        for laser in self.lasers:
            for name in laser.sees | laser.either:
                if name not in self.by_name:
                    raise LayerCaseError(f"laser {laser.name}: there is no entity {name!r}")
            if both := laser.sees & laser.either:
                raise LayerCaseError(f"laser {laser.name} both must and may see {min(both)!r}")
        for requirement in self.requirements:
            for name in required_entities(requirement):
                if self.relation(name, name) == "apart":
                    raise LayerCaseError(
                        f"contradiction: {requirement} needs a layer, but the {self.by_name[name].copies} copies of "
                        f"{name} share one list of layers, and nothing says that they may collide with each other: "
                        f"say so, or give one of them a model file of its own"
                    )

    def _check_contact(self, contact: ContactRequirement) -> None:
        for name in (contact.a, contact.b):
            if name not in self.by_name:
                raise LayerCaseError(f"there is no entity {name!r}")
        a, b = self.by_name[contact.a], self.by_name[contact.b]
        if a.kind == b.kind == "map" and a != b:
            raise LayerCaseError(
                f"{a.name} and {b.name} are maps: maps never collide, and a layer holds one at most"
            )
        if contact in self.required_contacts and contact in self.either:
            raise LayerCaseError(f"{contact} is both required and left open")
        if contact in self.required_contacts and (a.is_ghost or b.is_ghost):
            raise LayerCaseError(
                f"{(a if a.is_ghost else b).name} is a ghost: it cannot collide with anything"
            )

    @cached_property
    def by_name(self) -> Mapping[str, LayerEntity]:
        return {entity.name: entity for entity in self.entities}

    @cached_property
    def laser(self) -> Mapping[str, LaserEntity]:
        return {laser.name: laser for laser in self.lasers}

    @cached_property
    def required_contacts(self) -> frozenset[ContactRequirement]:
        """``collide`` as a set."""
        return frozenset(self.collide)

    @cached_property
    def may_share(self) -> Mapping[str, frozenset[str]]:
        """Returns, for each entity, the others that it may share a layer with: all whose relation is not ``apart``."""
        partners: dict[str, set[str]] = {name: set() for name in self.names}
        for contact in (*self.collide, *self.either):
            if contact.a != contact.b:
                partners[contact.a].add(contact.b)
                partners[contact.b].add(contact.a)
        for ghost in (entity for entity in self.entities if entity.is_ghost):
            for other in self.entities:
                if other is not ghost and not other.kind == ghost.kind == "map":
                    partners[ghost.name].add(other.name)
                    partners[other.name].add(ghost.name)
        return {name: frozenset(others) for name, others in partners.items()}

    @cached_property
    def must_meet(self) -> Mapping[str, frozenset[str]]:
        """Returns, for each entity, those it must collide with, itself among them where its copies must."""
        partners: dict[str, set[str]] = {name: set() for name in self.names}
        for contact in self.collide:
            partners[contact.a].add(contact.b)
            partners[contact.b].add(contact.a)
        return {name: frozenset(others) for name, others in partners.items()}

    @cached_property
    def names(self) -> tuple[str, ...]:
        return tuple(entity.name for entity in self.entities)

    @cached_property
    def requirements(self) -> tuple[Requirement, ...]:
        """Everything the layers have to bring about: the contacts as written, then the sightings."""
        sights = [
            SightRequirement(laser.name, name)
            for laser in self.lasers
            for name in self.names
            if name in laser.sees
        ]
        return (*self.collide, *sights)

    def relation(self, a: str, b: str) -> Relation:
        """Returns the relation of two entities, or (``a == b``) of the copies of one."""
        contact = ContactRequirement(a, b)
        if contact in self.required_contacts:
            return "collide"
        if contact in self.either:
            return "either"
        first, second = self.by_name[a], self.by_name[b]
        if a == b:
            return "either" if first.copies == 1 or first.is_ghost else "apart"
        if first.kind == second.kind == "map":
            return "apart"
        return "either" if first.is_ghost or second.is_ghost else "apart"

    def blind_set(self, laser: LaserEntity) -> frozenset[str]:
        """Returns the entities that the laser must not see."""
        return frozenset(self.names) - laser.sees - laser.either

    def edges(self) -> tuple[ContactRequirement, ...]:
        """The edges of the collision graph: the required contacts of two different entities."""
        return tuple(contact for contact in self.collide if contact.a != contact.b)

    def with_relation(self, a: str, b: str, relation: Relation) -> LayerCase:
        """The case with another relation of one pair; a new required contact goes to the end of the list."""
        contact = ContactRequirement(a, b)
        collide = tuple(c for c in self.collide if c != contact) if relation != "collide" else self.collide
        if relation == "collide" and contact not in self.required_contacts:
            collide = (*self.collide, contact)
        either = self.either | {contact} if relation == "either" else self.either - {contact}
        return replace(self, collide=collide, either=either)

    def with_sighting(self, laser: str, entity: str, sighting: Sighting) -> LayerCase:
        """The case with another relation of one laser to one entity."""

        def changed(old: LaserEntity) -> LaserEntity:
            sees, either = old.sees - {entity}, old.either - {entity}
            return LaserEntity(
                old.name,
                sees | {entity} if sighting == "sees" else sees,
                either | {entity} if sighting == "either" else either,
            )

        return replace(self, lasers=tuple(changed(old) if old.name == laser else old for old in self.lasers))

    def with_entity(self, entity: LayerEntity) -> LayerCase:
        return replace(self, entities=(*self.entities, entity))

    def with_laser(self, laser: LaserEntity) -> LayerCase:
        return replace(self, lasers=(*self.lasers, laser))

    def without_entity(self, name: str) -> LayerCase:
        """The case without an entity and everything said about it."""
        return replace(
            self,
            entities=tuple(entity for entity in self.entities if entity.name != name),
            collide=tuple(contact for contact in self.collide if name not in (contact.a, contact.b)),
            either=frozenset(contact for contact in self.either if name not in (contact.a, contact.b)),
            lasers=tuple(
                LaserEntity(old.name, old.sees - {name}, old.either - {name}) for old in self.lasers
            ),
        )

    def without_laser(self, name: str) -> LayerCase:
        return replace(self, lasers=tuple(laser for laser in self.lasers if laser.name != name))

    def without_requirements(self, requirements: Iterable[Requirement]) -> LayerCase:
        """The case in which these requirements are left open."""
        given_up = frozenset(requirements)
        contacts = frozenset(each for each in given_up if isinstance(each, ContactRequirement))
        sights = frozenset(each for each in given_up if isinstance(each, SightRequirement))

        def relaxed(laser: LaserEntity) -> LaserEntity:
            names = frozenset(sight.entity for sight in sights if sight.laser == laser.name)
            return LaserEntity(laser.name, laser.sees - names, laser.either | names)

        return replace(
            self,
            collide=tuple(contact for contact in self.collide if contact not in contacts),
            either=self.either | contacts,
            lasers=tuple(relaxed(laser) for laser in self.lasers) if sights else self.lasers,
        )

    def without_self_collisions(self) -> LayerCase:
        """The slides' assumption as a switch: bodies of one model never collide, so they may share layers.

        Flatland does not treat them so: two bodies of one model that share a layer and are not joined do
        collide. True of a model whose parts cannot reach each other. Copies of a model are not meant: with
        several instances in one list, a part of one can meet a part of another.
        """
        mates = [
            ContactRequirement(a.name, b.name)
            for a, b in combinations(self.entities, 2)
            if a.model and a.model == b.model and a.copies == b.copies == 1
        ]
        return replace(
            self,
            collide=tuple(contact for contact in self.collide if contact not in mates),
            either=self.either | frozenset(mates),
        )


def layer_conflict(case: LayerCase, one: Requirement, other: Requirement) -> str | None:
    """Explains why no layer can serve both requirements; None if one can.

    A layer that serves them holds all the entities they name, so no two of these may be ``apart``, and it is
    watched by the lasers they name, so none of these may be blind to any of those. Nothing else can stand in
    the way. This is the whole of the argument of a certificate, and it asks no solver.
    """
    entities = dict.fromkeys(name for requirement in (one, other) for name in required_entities(requirement))
    for a, b in combinations(entities, 2):
        if case.relation(a, b) == "apart":
            return f"{a} and {b} must not share a layer"
    lasers = dict.fromkeys(r.laser for r in (one, other) if isinstance(r, SightRequirement))
    for name in lasers:
        for entity in entities:
            if case.laser[name].sighting(entity) == "blind":
                return f"{name} must not see {entity}"
    return None


def required_entities(requirement: Requirement) -> tuple[str, ...]:
    """The entities a requirement names: a layer that brings it about holds them all."""
    return (
        (requirement.a, requirement.b)
        if isinstance(requirement, ContactRequirement)
        else (requirement.entity,)
    )


def _check_unique(what: str, names: list[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise LayerCaseError(f"the {what} {name!r} is named twice")
        seen.add(name)
