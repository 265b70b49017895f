"""Finds each part of a requirements file in the user's own world, and makes a case of the two.

Everything in the world has to be named: a body that is not mentioned would have to touch nothing, which is rarely meant.
Relations of bodies that can never meet (two static bodies, joined bodies, the footprints of one body) cost nothing and are
dropped; but a collision that can never happen is a mistake.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import product

from kit.layers.flatland.layer_lists import FootprintUse, LaserLayerList, LayerLists
from kit.layers.flatland.world_case import WorldCase, build_case
from kit.layers.requirements import ContactRequirement, LayerCase, Relation, Sighting
from kit.layers.requirements_file import RequirementsFile
from kit.plain_text import quoted, suggestion
from kit.world.problems import ProblemCollector
from kit.world.records import LaserMount as View
from kit.world.records import SourceLocation


def bind_requirements(requirements: RequirementsFile, layer_lists: LayerLists) -> WorldCase:
    """The case that the requirements are for this world. Raises WorldError where they do not fit it."""
    problems = ProblemCollector()
    binding = _RequirementBinding(requirements, layer_lists, problems)
    problems.raise_if_any()
    binding.check_possible()
    problems.raise_if_any()
    return build_case(
        layer_lists, binding.pair, binding.view, title=requirements.case.title or layer_lists.world.file.name
    )


class _RequirementBinding:
    """Matches every footprint use and laser of the world with an entity and a laser of the case."""

    def __init__(
        self, requirements: RequirementsFile, layer_lists: LayerLists, problems: ProblemCollector
    ) -> None:
        self._requirements, self._slots, self._problems = requirements, layer_lists, problems
        self._case: LayerCase = requirements.case
        self._spots = [
            use for layer_list in (*layer_lists.maps, *layer_lists.bodies) for use in layer_list.uses
        ]
        self._entity: Mapping[str, str] = dict(self._match_entities())
        self._laser: Mapping[tuple[SourceLocation, str], str] = dict(self._match_lasers())
        models = {name for names in requirements.copies.values() for name in names}
        for use in self._spots:
            if use.address not in self._entity and use.model in models:
                self._add_problem(
                    f"{use.address} belongs to no part in the requirements: name its body under bodies"
                )

    # Relations that the case requires of footprint uses

    def pair(self, a: FootprintUse, b: FootprintUse) -> Relation:
        one, other = self._entity[a.address], self._entity[b.address]
        if one == other and a.model == b.model:
            return "collide" if ContactRequirement(one, one) in self._case.required_contacts else "either"
        return self._case.relation(one, other)

    def view(self, laser: LaserLayerList, laser_use: tuple[str, View], use: FootprintUse) -> Sighting:
        return self._case.laser[self._laser[laser.location, laser_use[0]]].sighting(self._entity[use.address])

    def check_possible(self) -> None:
        """Notes every required collision that can never happen."""
        uses: dict[str, list[FootprintUse]] = {}
        for use in self._spots:
            uses.setdefault(self._entity[use.address], []).append(use)
        for contact in self._case.collide:
            pairs = [(a, b) for a, b in product(uses[contact.a], uses[contact.b]) if a != b]
            if not any(self._slots.can_collide(a, b) for a, b in pairs):
                why = self._slots.no_contact_reason(*pairs[0]) if pairs else "there is only one"
                location = self._requirements.locations.get(contact, SourceLocation(self._requirements.file))
                self._problems.add(
                    location, f"{contact.a} and {contact.b} can never collide in this world: {why}"
                )

    # Finding the names in the world

    def _match_entities(self) -> Iterator[tuple[str, str]]:
        yield from self._match_maps()
        models = {model.name for model in self._slots.world.models}
        stated = Counter(name for names in self._requirements.copies.values() for name in names)
        for model in sorted(models - stated.keys()):
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
        for layer, layer_list in zip(layers, self._slots.maps, strict=True):
            names = [name for name in layer.names if name in wanted]
            if len(names) > 1:
                self._add_problem(
                    f"{quoted(names[0])} and {quoted(names[1])} are names of one map: keep one of them"
                )
            elif not names:
                self._add_problem(
                    f"the world's map {quoted(layer.name)} is not in the requirements: name it under maps"
                )
            yield layer_list.uses[0].address, names[0] if names else ""

    def _match_bodies(self, entity: str, model: str, instances: list[str]) -> Iterator[tuple[str, str]]:
        """Returns the uses of an entity: all of a model's, or those of the bodies named."""
        part = entity.removeprefix(f"{model}.") if entity != model else ""
        wanted = self._requirements.bodies.get(entity, (part,) if part else ())
        for instance in instances:
            own = [use for use in self._spots if use.model == instance]
            known = dict.fromkeys(use.body.body for use in own)
            for body in wanted:
                if not any(body in (use.body.body, f"{use.body.body}.{use.number}") for use in own):
                    self._add_problem(
                        f"{entity}: {instance} has no body {quoted(body)}: {suggestion(body, list(known))}"
                    )
            for use in own:
                if not wanted or use.body.body in wanted or f"{use.body.body}.{use.number}" in wanted:
                    yield use.address, entity

    def _match_lasers(self) -> Iterator[tuple[tuple[SourceLocation, str], str]]:
        laser_uses = [
            (layer_list, model) for layer_list in self._slots.lasers for model, _ in layer_list.uses
        ]
        plugins = Counter(layer_list.plugin for layer_list in self._slots.lasers)
        called: dict[str, list[tuple[SourceLocation, str]]] = {}
        for layer_list, model in laser_uses:
            names = [
                f"{key}.{layer_list.plugin}"
                for key, names in self._requirements.copies.items()
                if model in names
            ]
            for name in [*names, *([layer_list.plugin] if plugins[layer_list.plugin] == 1 else [])]:
                called.setdefault(name, []).append((layer_list.location, model))
        for laser in self._case.lasers:
            if laser.name not in called:
                self._add_problem(
                    f"the world has no laser {quoted(laser.name)}: {suggestion(laser.name, list(called))}"
                )
            yield from ((laser_use, laser.name) for laser_use in called.get(laser.name, ()))
        found = {laser_use for laser in self._case.lasers for laser_use in called.get(laser.name, ())}
        for layer_list, model in laser_uses:
            if (layer_list.location, model) not in found:
                self._add_problem(
                    f"the world's laser {model}.{layer_list.plugin} is not in the requirements: name it under lasers"
                )

    def _add_problem(self, message: str) -> None:
        self._problems.add(SourceLocation(self._requirements.file), message)
