"""What each key means in a sheet of the kind ``drive``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "drive": "Where was driven",
        "drive.place": "A map of the kit, or a world file in this folder (then with `target`)",
        "drive.case": "Which start and target of the map",
        "drive.target": "The target [m]; one of its own instead of the map's",
        "drive.target_radius": "How near counts as reached [m]",
        "drive.time": "The longest drive that counts [simulated s]",
    }
)
