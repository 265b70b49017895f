"""What each key means in a sheet of the kind ``reward``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "grid": "A small model of the task",
        "grid.map": "Cells of 0.25 m: # wall, . floor, G target",
        "grid.discount": "The discount with which returns are compared",
        "grid.max_steps": "Steps of an episode",
    }
)
