"""Every list of layer names in the files of a Flatland world, and what in the world it decides.

A *slot* is one such list: the ``name`` of an entry of ``layers``, the ``layers`` of a footprint, or those of a
laser. Flatland has no layers per model instance: all instances of a model file share its lists, so whoever plans
plans slots, not bodies. A *spot* is a footprint of one instance (or the walls of an entry), and every spot is
decided by one slot.

What can happen between two spots if they share a layer, and what a laser could see, is asked of
``kit.world.collision_rules``; here stands only which spots are meant.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from kit.world.collision_rules import (
    CollisionBody,
    CollisionFilter,
    CollisionRules,
    ContactKind,
    footprint_contains,
)
from kit.world.loading import load_world
from kit.world.plugin_reader import ModelScope, PluginReader
from kit.world.records import Footprint, LaserMount, Model, SourceLocation, World
from kit.world.yaml_section import REQUIRED, Section

REFLECTANCE_LAYER: Final = "reflectance"
"""The layer whose name means something to lasers: what is in it shines. It is kept as it is."""


@dataclass(frozen=True, slots=True)
class FootprintUse:
    """A footprint of a model instance, or the walls of an entry of ``layers``."""

    body: CollisionBody
    """The body with this footprint alone, as if everything were in one layer."""
    category: int
    """The layers it is in today, as bits."""
    footprint: Footprint | None
    number: int
    """Which footprint of its body, from 0."""

    @property
    def model(self) -> str:
        return self.body.model or ""

    @property
    def address(self) -> str:
        return f"{self.model}/{self.body.body}[{self.number}]" if self.footprint else self.body.name


@dataclass(frozen=True, slots=True)
class LayerList:
    """One list of layer names in a file."""

    location: SourceLocation
    """Of the mapping that holds the list."""
    names: tuple[str, ...]
    """As it stands there, or ``("all",)`` where nothing does."""
    uses: tuple[FootprintUse, ...] = ()

    @property
    def models(self) -> tuple[str, ...]:
        """The model instances that share the list, in order; none for a map."""
        return tuple(dict.fromkeys(spot.model for spot in self.uses if spot.model))


@dataclass(frozen=True, slots=True)
class LaserLayerList:
    """The list of a laser: which plugin of which model instances, and what each looks at."""

    location: SourceLocation
    names: tuple[str, ...]
    plugin: str
    uses: tuple[tuple[str, LaserMount], ...]


@dataclass(frozen=True, slots=True)
class _LaserParams:
    """What the planner reads of a laser."""

    layers: tuple[str, ...]
    mount: LaserMount


@dataclass(frozen=True)
class LayerLists:
    """All slots of one world."""

    world: World
    maps: tuple[LayerList, ...]
    bodies: tuple[LayerList, ...]
    lasers: tuple[LaserLayerList, ...]
    one_model_never_collides: bool = False
    _collision_rules: CollisionRules = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_collision_rules", CollisionRules(self.world))

    def can_collide(self, a: FootprintUse, b: FootprintUse) -> bool:
        """Whether anything happens between two spots that share a layer."""
        if self.one_model_never_collides and a.model and a.model == b.model:
            return False
        return self._collision_rules.contact_rule(a.body, b.body).kind is not ContactKind.PASSES

    def no_contact_reason(self, a: FootprintUse, b: FootprintUse) -> str:
        """Why nothing happens between two spots that cannot meet, in words."""
        if self.one_model_never_collides and a.model and a.model == b.model:
            return "bodies of one model never collide, as you say"
        return self._collision_rules.contact_rule(a.body, b.body).explanation

    def can_see(self, use: tuple[str, LaserMount], spot: FootprintUse) -> bool:
        """Whether a laser that watches one of the spot's layers can see it."""
        model, sight = use
        if spot.footprint is None:
            return True
        own = spot.model == model and spot.body.body == sight.body
        return not spot.footprint.sensor and not (own and footprint_contains(spot.footprint, sight.origin))

    @property
    def kept_layers(self) -> tuple[str, ...]:
        """Layers whose name has a meaning of its own, which must go on to hold what they hold."""
        return (REFLECTANCE_LAYER,) if REFLECTANCE_LAYER in self.world.layer_bits else ()

    def kept_bits(self, slot: LayerList) -> int:
        """The kept layers that a slot is in."""
        return slot.uses[0].category & sum(self.world.layer_bits[name] for name in self.kept_layers)


def read_world_layers(
    path: Path, *, root: Path | None = None, environment: Mapping[str, str] | None = None
) -> World:
    """A world as the planner needs it: every plugin is let pass, and a laser says what it looks at.

    Raises WorldError with all that is wrong. ``root`` is the folder the world may not leave, by default its own;
    ``environment`` the variables that ``env()`` in its files may read, by default none.
    """
    return load_world(path, plugin_readers=_LaserOnlyReaders(), root=root, environment=environment)


def find_layer_lists(world: World, *, one_model_never_collides: bool = False) -> LayerLists:
    """The slots of a world that ``read_world`` has read."""
    maps = tuple(
        LayerList(
            layer.location,
            layer.names,
            (
                FootprintUse(
                    CollisionBody(None, layer.name, False, frozenset({CollisionFilter(1, 1, False)})),
                    layer.bits,
                    None,
                    0,
                ),
            ),
        )
        for layer in world.layers
        if layer.walls is not None
    )
    bodies: dict[SourceLocation, LayerList] = {}
    lasers: dict[SourceLocation, LaserLayerList] = {}
    for model in world.models:
        for place, written, spot in _footprint_uses(model):
            old = bodies.get(place, LayerList(place, written))
            bodies[place] = LayerList(place, written, (*old.uses, spot))
        for plugin in model.plugins:
            if isinstance(params := plugin.params, _LaserParams):
                uses = lasers[plugin.location].uses if plugin.location in lasers else ()
                use = (model.name, params.mount)
                lasers[plugin.location] = LaserLayerList(
                    plugin.location, params.layers, plugin.name, (*uses, use)
                )
    return LayerLists(world, maps, tuple(bodies.values()), tuple(lasers.values()), one_model_never_collides)


def _footprint_uses(model: Model) -> Iterator[tuple[SourceLocation, tuple[str, ...], FootprintUse]]:
    for body in model.bodies:
        for number, footprint in enumerate(body.footprints):
            surface = CollisionFilter(1, 1 if footprint.collision else 0, footprint.sensor)
            thing = CollisionBody(model.name, body.name, body.kind == "dynamic", frozenset({surface}))
            yield (
                footprint.location,
                footprint.layers,
                FootprintUse(thing, footprint.category, footprint, number),
            )


class _LaserOnlyReaders(Mapping[str, PluginReader]):
    """Readers for every type of plugin there may be: of lasers what matters here, of all others nothing."""

    def __getitem__(self, type_: str) -> PluginReader:
        return _read_laser if type_ == "Laser" else _read_other

    def __contains__(self, type_: object) -> bool:
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(("Laser",))

    def __len__(self) -> int:
        return 1


def _read_laser(section: Section, scope: ModelScope) -> object:
    body = scope.body(section, "body", REQUIRED)
    sight = LaserMount(body, scope.layers(section), section.pose("origin", LaserMount(body, 0).origin))
    params = _LaserParams(section.texts("layers", ("all",)), sight)
    section.remaining_values()
    return params


def _read_other(section: Section, scope: ModelScope) -> object:
    return section.remaining_values()
