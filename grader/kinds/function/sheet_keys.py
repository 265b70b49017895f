"""What each key means in a sheet of the kind ``function``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "functions": "What is called",
        "functions.name": "The function, of the same name in reference.py, where NAME_cases(chance) yields the calls",
        "functions.within": "How far a number may be off",
        "seed": "Of the calls, for practice",
        "secret.seed": "In secret.yaml: that for the grade",
    }
)
