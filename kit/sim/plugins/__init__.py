"""The plugins: one file each, found by looking into this folder; others' packages bring more.

``plugin_readers`` and ``world_plugin_readers`` hold the parameter reader of each type, for ``load_world``.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Generic, TypeVar

from kit.extensions import ExtensionError, extensions, load
from kit.sim.plugin import PluginType, WorldPluginType
from kit.world.plugin_reader import PluginReader, WorldPluginReader

_PLUGIN_TYPES = [
    importlib.import_module(f"{__name__}.{module.name}").PLUGIN_TYPE
    for module in pkgutil.iter_modules(__path__)
]

plugin_types: Mapping[str, PluginType] = MappingProxyType(
    {d.type: d for d in _PLUGIN_TYPES if isinstance(d, PluginType)}
)
"""The kit's own types of model plugins."""
world_plugin_types: Mapping[str, WorldPluginType] = MappingProxyType(
    {d.type: d for d in _PLUGIN_TYPES if isinstance(d, WorldPluginType)}
)
"""The kit's own types of world plugins."""

KindT = TypeVar("KindT", PluginType, WorldPluginType)
ReaderT = TypeVar("ReaderT")


class _Readers(Mapping[str, ReaderT], Generic[KindT, ReaderT]):
    """The readers of the kit's own types, and of those that others' packages bring. Such a one is loaded when it is first
    named; one that cannot be used is as if it were not there."""

    def __init__(
        self, own: Mapping[str, KindT], kind: type[KindT], reader_of: Callable[[KindT], ReaderT]
    ) -> None:
        self._own = {name: reader_of(each) for name, each in own.items()}
        self._kind: type[KindT] = kind
        self._reader_of: Callable[[KindT], ReaderT] = reader_of

    def __getitem__(self, name: str) -> ReaderT:
        if name in self._own:
            return self._own[name]
        part = extensions("devices", [*plugin_types, *world_plugin_types])[name]
        try:
            found = load(part)
        except ExtensionError as error:
            raise KeyError(name) from error
        if not isinstance(found, self._kind) or found.type != name:
            raise KeyError(name)
        return self._reader_of(found)

    def __iter__(self) -> Iterator[str]:
        yield from self._own
        yield from (
            name for name in extensions("devices", [*plugin_types, *world_plugin_types]) if name in self
        )

    def __len__(self) -> int:
        return sum(1 for _ in self)


def _reader(type_: PluginType) -> PluginReader:
    return type_.read_params


def _world_reader(type_: WorldPluginType) -> WorldPluginReader:
    return type_.read_params


plugin_readers: Mapping[str, PluginReader] = _Readers(plugin_types, PluginType, _reader)
world_plugin_readers: Mapping[str, WorldPluginReader] = _Readers(
    world_plugin_types, WorldPluginType, _world_reader
)
