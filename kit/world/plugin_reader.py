"""The contract between the world loader and the readers of plugin parameters.

A plugin reader gets the plugin's ``Section`` (name, type and enabled already taken) and the scope it stands
in, asks for its keys, and returns a frozen record. The loader calls ``finish()`` after it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol, TypeAlias, TypeVar

from kit.plain_text import quoted, suggestion
from kit.world.records import ALL_LAYERS, Layer, Model, PluginSpec
from kit.world.yaml_section import REQUIRED, Required, Section

FLATLAND_PREFIX = "flatland_plugins::"
"""Optional prefix of the types of Flatland's own plugins."""

ScopeT = TypeVar("ScopeT")
NamedT = TypeVar("NamedT", bound="_HasName")


class _HasName(Protocol):
    @property
    def name(self) -> str: ...


def read_named(
    sections: Iterable[Section], what: str, read: Callable[[Section], NamedT]
) -> tuple[NamedT, ...]:
    """Reads entries with unique names. Those with ``enabled: false`` are skipped, unread."""
    found: dict[str, NamedT] = {}
    for section in sections:
        if not section.flag("enabled", True):
            continue
        body = read(section)
        section.finish()
        if body.name and body.name in found:
            section.error(f"a {what} named {quoted(body.name)} already exists", "name")
        found.setdefault(body.name, body)
    return tuple(found.values())


def read_plugins(
    sections: Iterable[Section],
    scope: ScopeT,
    readers: Mapping[str, Callable[[Section, ScopeT], object]] | None,
) -> tuple[PluginSpec, ...]:
    """The plugins of a model or of the world. Without ``readers`` their types are not checked, and their
    parameters stay a plain mapping.
    """

    def read(section: Section) -> PluginSpec:
        name = section.name("name")
        type_ = section.text("type").removeprefix(FLATLAND_PREFIX)
        if readers is None:
            return PluginSpec(name, type_, section.remaining_values(), section.location)
        if type_ in readers:
            return PluginSpec(name, type_, readers[type_](section, scope), section.location)
        if type_:
            section.error(f"there is no plugin {quoted(type_)}: {suggestion(type_, readers)}", "type")
        return PluginSpec(name, type_, section.remaining_values(), section.location)

    return read_named(sections, "plugin", read)


def read_layer_names(
    section: Section, key: str, layer_bits: Mapping[str, int]
) -> tuple[tuple[str, ...], int]:
    """Layer names as written (by default ``("all",)``) and their bits.

    "all" means every layer only where it stands alone; beside others it is the name of a layer.
    """
    names = section.texts(key, ("all",))
    if names == ("all",):
        return names, ALL_LAYERS
    bits = 0
    for name in names:
        if name in layer_bits:
            bits |= layer_bits[name]
        else:
            section.error(
                f"there is no layer {quoted(name)} in this world: {suggestion(name, layer_bits)}", key
            )
    return names, bits


def _read_known_name(
    section: Section, key: str, names: Collection[str], what: str, default: str | Required
) -> str:
    name = section.name(key, default)
    if section.has(key) and name and name not in names:
        section.error(f"{what} has the name {quoted(name)}: {suggestion(name, names)}", key)
    return name


@dataclass(frozen=True, slots=True)
class ModelScope:
    """The names that a model plugin's parameters may refer to. ``model`` is complete but for its plugins."""

    model: Model
    layer_bits: Mapping[str, int]

    def layers(self, section: Section, key: str = "layers") -> int:
        """The bits of a list of layer names; all of them where the key is missing."""
        return read_layer_names(section, key, self.layer_bits)[1]

    def body(self, section: Section, key: str, default: str | Required = REQUIRED) -> str:
        """The name of a body of the model."""
        return _read_known_name(section, key, [body.name for body in self.model.bodies], "no body", default)

    def joint(self, section: Section, key: str) -> str:
        """The name of a joint of the model."""
        return _read_known_name(
            section, key, [joint.name for joint in self.model.joints], "no joint", REQUIRED
        )

    def bodies(self, section: Section, key: str) -> tuple[str, ...]:
        """A list of names of bodies of the model; empty where the key is missing."""
        known = [body.name for body in self.model.bodies]
        names = section.texts(key, ())
        for name in names:
            if name not in known:
                section.error(f"no body has the name {quoted(name)}: {suggestion(name, known)}", key)
        return tuple(name for name in names if name in known)


@dataclass(frozen=True, slots=True)
class WorldScope:
    """The names that a world plugin's parameters may refer to."""

    layers: tuple[Layer, ...]
    models: tuple[Model, ...]
    layer_bits: Mapping[str, int]

    def layer(self, section: Section, key: str, default: str | Required = REQUIRED) -> str:
        """The name of a layer (any of its names)."""
        return _read_known_name(section, key, self.layer_bits, "no layer", default)

    def model(self, section: Section, key: str, default: str | Required = REQUIRED) -> str:
        """The name of a model of the world file."""
        return _read_known_name(section, key, [model.name for model in self.models], "no model", default)


PluginReader: TypeAlias = Callable[[Section, ModelScope], object]
"""Reads the parameters of one type of model plugin."""

WorldPluginReader: TypeAlias = Callable[[Section, WorldScope], object]
"""Reads the parameters of one type of world plugin."""
