"""The plugins: one file each, found by looking into this folder.

``plugin_readers`` and ``world_plugin_readers`` hold the parameter reader of each type, for ``load_world``.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from types import MappingProxyType

from kit.sim.plugin import PluginType, WorldPluginType
from kit.world.plugin_reader import PluginReader, WorldPluginReader

_PLUGIN_TYPES = [
    importlib.import_module(f"{__name__}.{module.name}").PLUGIN_TYPE
    for module in pkgutil.iter_modules(__path__)
]

plugin_types: Mapping[str, PluginType] = MappingProxyType(
    {d.type: d for d in _PLUGIN_TYPES if isinstance(d, PluginType)}
)
world_plugin_types: Mapping[str, WorldPluginType] = MappingProxyType(
    {d.type: d for d in _PLUGIN_TYPES if isinstance(d, WorldPluginType)}
)
plugin_readers: Mapping[str, PluginReader] = MappingProxyType(
    {name: d.read_params for name, d in plugin_types.items()}
)
world_plugin_readers: Mapping[str, WorldPluginReader] = MappingProxyType(
    {name: d.read_params for name, d in world_plugin_types.items()}
)
