"""The devices: one file each, found by looking into this folder.

``readers`` and ``world_readers`` are what ``load_world`` wants: who reads the parameters of each type.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from types import MappingProxyType

from kit.sim.context import Device, WorldDevice
from kit.world.plugin_reader import DeviceReader, WorldDeviceReader

_FOUND = [
    importlib.import_module(f"{__name__}.{module.name}").DEVICE for module in pkgutil.iter_modules(__path__)
]

devices: Mapping[str, Device] = MappingProxyType({d.type: d for d in _FOUND if isinstance(d, Device)})
world_devices: Mapping[str, WorldDevice] = MappingProxyType(
    {d.type: d for d in _FOUND if isinstance(d, WorldDevice)}
)
readers: Mapping[str, DeviceReader] = MappingProxyType({name: d.read for name, d in devices.items()})
world_readers: Mapping[str, WorldDeviceReader] = MappingProxyType(
    {name: d.read for name, d in world_devices.items()}
)
