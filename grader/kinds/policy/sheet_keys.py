"""What each key means in a sheet of the kind ``policy``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "policy": "What the policy is tested on",
        "policy.task": "A task of the kit, or a task file in this folder",
        "policy.episodes": "Episodes of each case",
        "seed": "Of the test, for practice",
        "secret.seed": "In secret.yaml: that for the grade",
    }
)
