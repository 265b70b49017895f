"""Every list of layer names in the files of a Flatland world, and the footprints that it decides about.

A *layer list* is the ``name`` of an entry of ``layers``, the ``layers`` of a footprint, or those of a
laser. Flatland has no layers per model instance: all instances of a model file share its lists, so the
planner assigns lists, not bodies. A *footprint use* is a footprint of one instance (or the walls of an entry), and
every use is decided by one list.

``kit.world.collision_rules`` tells what happens between two uses that share a layer, and what a laser sees.
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
"""The layer whose name has a meaning to lasers: its members reflect. It is kept as it is."""


@dataclass(frozen=True, slots=True)
class FootprintUse:
    """A footprint of a model instance, or the walls of an entry of ``layers``."""

    body: CollisionBody
    """The body with this footprint alone, as if everything were in one layer."""
    category: int
    """The layers it is in today, as bits."""
    footprint: Footprint | None
    number: int
    """Index of the footprint in its body, from 0."""

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
    """Location of the mapping that contains the list."""
    names: tuple[str, ...]
    """The names as written, or ``("all",)`` without a list."""
    uses: tuple[FootprintUse, ...] = ()

    @property
    def models(self) -> tuple[str, ...]:
        """The model instances that share the list, in order; none for a map."""
        return tuple(dict.fromkeys(use.model for use in self.uses if use.model))


@dataclass(frozen=True, slots=True)
class LaserLayerList:
    """The list of a laser: which plugin of which model instances, and what each looks at."""

    location: SourceLocation
    names: tuple[str, ...]
    plugin: str
    uses: tuple[tuple[str, LaserMount], ...]


@dataclass(frozen=True, slots=True)
class _LaserParams:
    """The parameters of a laser that the planner needs."""

    layers: tuple[str, ...]
    mount: LaserMount


@dataclass(frozen=True)
class LayerLists:
    """All layer lists of one world."""

    world: World
    maps: tuple[LayerList, ...]
    bodies: tuple[LayerList, ...]
    lasers: tuple[LaserLayerList, ...]
    one_model_never_collides: bool = False
    _collision_rules: CollisionRules = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_collision_rules", CollisionRules(self.world))

    def can_collide(self, a: FootprintUse, b: FootprintUse) -> bool:
        """Returns whether two uses that share a layer would collide or sense each other."""
        if self.one_model_never_collides and a.model and a.model == b.model:
            return False
        return self._collision_rules.contact_rule(a.body, b.body).kind is not ContactKind.PASSES

    def no_contact_reason(self, a: FootprintUse, b: FootprintUse) -> str:
        """Explains why two uses cannot collide."""
        if self.one_model_never_collides and a.model and a.model == b.model:
            return "bodies of one model are assumed never to collide"
        return self._collision_rules.contact_rule(a.body, b.body).explanation

    def can_see(self, laser_use: tuple[str, LaserMount], use: FootprintUse) -> bool:
        """Returns whether a laser that watches one of the use's layers can see it."""
        model, mount = laser_use
        if use.footprint is None:
            return True
        own = use.model == model and use.body.body == mount.body
        return not use.footprint.sensor and not (own and footprint_contains(use.footprint, mount.origin))

    @property
    def kept_layers(self) -> tuple[str, ...]:
        """Layers whose name has a meaning of its own, which must go on to hold what they hold."""
        return (REFLECTANCE_LAYER,) if REFLECTANCE_LAYER in self.world.layer_bits else ()

    def kept_bits(self, layer_list: LayerList) -> int:
        """Returns the bits of the kept layers that a list names."""
        return layer_list.uses[0].category & sum(self.world.layer_bits[name] for name in self.kept_layers)


def read_world_layers(
    path: Path, *, root: Path | None = None, environment: Mapping[str, str] | None = None
) -> World:
    """Loads a world for the planner: plugins are not checked, and of lasers only layers and mount are read.

    Raises WorldError with all that is wrong. ``root`` is the folder the world may not leave, by default its own;
    ``environment`` the variables that ``env()`` in its files may read, by default none.
    """
    return load_world(path, plugin_readers=_LaserOnlyReaders(), root=root, environment=environment)


def find_layer_lists(world: World, *, one_model_never_collides: bool = False) -> LayerLists:
    """Returns the layer lists of a world that ``read_world_layers`` has loaded."""
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
        for location, written, use in _footprint_uses(model):
            old = bodies.get(location, LayerList(location, written))
            bodies[location] = LayerList(location, written, (*old.uses, use))
        for plugin in model.plugins:
            if isinstance(params := plugin.params, _LaserParams):
                laser_uses = lasers[plugin.location].uses if plugin.location in lasers else ()
                laser_use = (model.name, params.mount)
                lasers[plugin.location] = LaserLayerList(
                    plugin.location, params.layers, plugin.name, (*laser_uses, laser_use)
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
    mount = LaserMount(body, scope.layers(section), section.pose("origin", LaserMount(body, 0).origin))
    params = _LaserParams(section.texts("layers", ("all",)), mount)
    section.remaining_values()
    return params


def _read_other(section: Section, scope: ModelScope) -> object:
    return section.remaining_values()
