"""What each key means in a sheet of the kind ``plan``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "case": "What is asked: a requirements file as `kit layers plan` reads it, or one of its examples",
        "secret.case": "In secret.yaml: another one, for the grade",
    }
)
