"""A requirements file laid over a Flatland world: its names found there, its wishes turned into lists to write.

Everything in the world has to be named: what nobody mentions would be asked to touch nothing, and that is too
much to read into a silence. Wishes about things that can never meet (two static bodies, joined bodies, the
footprints of one body) cost nothing and are dropped; but a collision that can never happen is a mistake.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import product

from kit.layers.flatland.layer_lists import FootprintUse, LaserLayerList, LayerLists
from kit.layers.flatland.world_case import WorldCase, build_case
from kit.layers.reading import RequirementsFile
from kit.layers.requirements import ContactRequirement, LayerCase, Relation, Sighting
from kit.plain_text import quoted, suggestion
from kit.world.problems import ProblemCollector
from kit.world.records import LaserMount as View
from kit.world.records import SourceLocation


def bind_requirements(requirements: RequirementsFile, slots: LayerLists) -> WorldCase:
    """The case that the requirements are for this world. Raises WorldError where they do not fit it."""
    problems = ProblemCollector()
    binding = _RequirementBinding(requirements, slots, problems)
    problems.raise_if_any()
    binding.check_possible()
    problems.raise_if_any()
    return build_case(
        slots, binding.pair, binding.view, title=requirements.case.title or slots.world.file.name
    )


class _RequirementBinding:
    """Matches every footprint use and laser of the world with an entity and a laser of the case."""

    def __init__(self, requirements: RequirementsFile, slots: LayerLists, problems: ProblemCollector) -> None:
        self._requirements, self._slots, self._problems = requirements, slots, problems
        self._case: LayerCase = requirements.case
        self._spots = [spot for slot in (*slots.maps, *slots.bodies) for spot in slot.uses]
        self._entity: Mapping[str, str] = dict(self._match_entities())
        self._laser: Mapping[tuple[SourceLocation, str], str] = dict(self._match_lasers())
        models = {name for names in requirements.copies.values() for name in names}
        for spot in self._spots:
            if spot.address not in self._entity and spot.model in models:
                self._add_problem(
                    f"{spot.address} belongs to no part in the requirements: name its body under bodies"
                )

    # What the case asks of spots

    def pair(self, a: FootprintUse, b: FootprintUse) -> Relation:
        one, other = self._entity[a.address], self._entity[b.address]
        if one == other and a.model == b.model:
            return "collide" if ContactRequirement(one, one) in self._case.required_contacts else "either"
        return self._case.relation(one, other)

    def view(self, laser: LaserLayerList, use: tuple[str, View], spot: FootprintUse) -> Sighting:
        return self._case.laser[self._laser[laser.location, use[0]]].sighting(self._entity[spot.address])

    def check_possible(self) -> None:
        """Notes every required collision that can never happen."""
        spots: dict[str, list[FootprintUse]] = {}
        for spot in self._spots:
            spots.setdefault(self._entity[spot.address], []).append(spot)
        for contact in self._case.collide:
            pairs = [(a, b) for a, b in product(spots[contact.a], spots[contact.b]) if a != b]
            if not any(self._slots.can_collide(a, b) for a, b in pairs):
                why = self._slots.no_contact_reason(*pairs[0]) if pairs else "there is only one"
                place = self._requirements.locations.get(contact, SourceLocation(self._requirements.file))
                self._problems.add(
                    place, f"{contact.a} and {contact.b} can never collide in this world: {why}"
                )

    # Finding the names in the world

    def _match_entities(self) -> Iterator[tuple[str, str]]:
        yield from self._match_maps()
        models = {model.name for model in self._slots.world.models}
        said = Counter(name for names in self._requirements.copies.values() for name in names)
        for model in sorted(models - said.keys()):
            self._add_problem(
                f"the world's model {quoted(model)} is not in the requirements: name it under models"
            )
        for model, names in self._requirements.copies.items():
            for name in names:
                if name not in models:
                    self._add_problem(f"the world has no model {quoted(name)}: {suggestion(name, models)}")
            for entity in self._case.entities:
                if entity.kind == "bodies" and entity.model == model:
                    yield from self._match_bodies(
                        entity.name, model, [name for name in names if name in models]
                    )

    def _match_maps(self) -> Iterator[tuple[str, str]]:
        layers = [layer for layer in self._slots.world.layers if layer.walls is not None]
        known = [name for layer in layers for name in layer.names]
        wanted = {entity.name for entity in self._case.entities if entity.kind == "map"}
        for name in sorted(wanted - set(known)):
            self._add_problem(f"the world has no map called {quoted(name)}: {suggestion(name, known)}")
        for layer, slot in zip(layers, self._slots.maps, strict=True):
            names = [name for name in layer.names if name in wanted]
            if len(names) > 1:
                self._add_problem(
                    f"{quoted(names[0])} and {quoted(names[1])} are names of one map: keep one of them"
                )
            elif not names:
                self._add_problem(
                    f"the world's map {quoted(layer.name)} is not in the requirements: name it under maps"
                )
            yield slot.uses[0].address, names[0] if names else ""

    def _match_bodies(self, entity: str, model: str, instances: list[str]) -> Iterator[tuple[str, str]]:
        """The spots of an entity: all of a model's, or those of the bodies named."""
        part = entity.removeprefix(f"{model}.") if entity != model else ""
        wanted = self._requirements.bodies.get(entity, (part,) if part else ())
        for instance in instances:
            own = [spot for spot in self._spots if spot.model == instance]
            known = dict.fromkeys(spot.body.body for spot in own)
            for body in wanted:
                if not any(body in (spot.body.body, f"{spot.body.body}.{spot.number}") for spot in own):
                    self._add_problem(
                        f"{entity}: {instance} has no body {quoted(body)}: {suggestion(body, list(known))}"
                    )
            for spot in own:
                if not wanted or spot.body.body in wanted or f"{spot.body.body}.{spot.number}" in wanted:
                    yield spot.address, entity

    def _match_lasers(self) -> Iterator[tuple[tuple[SourceLocation, str], str]]:
        uses = [(slot, model) for slot in self._slots.lasers for model, _ in slot.uses]
        plugins = Counter(slot.plugin for slot in self._slots.lasers)
        called: dict[str, list[tuple[SourceLocation, str]]] = {}
        for slot, model in uses:
            names = [
                f"{key}.{slot.plugin}" for key, names in self._requirements.copies.items() if model in names
            ]
            for name in [*names, *([slot.plugin] if plugins[slot.plugin] == 1 else [])]:
                called.setdefault(name, []).append((slot.location, model))
        for laser in self._case.lasers:
            if laser.name not in called:
                self._add_problem(
                    f"the world has no laser {quoted(laser.name)}: {suggestion(laser.name, list(called))}"
                )
            yield from ((use, laser.name) for use in called.get(laser.name, ()))
        found = {use for laser in self._case.lasers for use in called.get(laser.name, ())}
        for slot, model in uses:
            if (slot.location, model) not in found:
                self._add_problem(
                    f"the world's laser {model}.{slot.plugin} is not in the requirements: name it under lasers"
                )

    def _add_problem(self, message: str) -> None:
        self._problems.add(SourceLocation(self._requirements.file), message)
