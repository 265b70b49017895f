"""What each key means in a sheet of the kind ``training``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "training": "How the settings are tried",
        "training.task": "The task that is trained",
        "training.reward": "The reward, by default the task's",
        "training.scale": "Its factor, by default the task's",
        "training.algorithms": "Those that may be chosen",
        "training.steps": "Steps of each training",
        "training.episodes": "Episodes of the test",
        "training.seeds": "One training each, for practice",
        "secret.seeds": "In secret.yaml: those for the grade",
    }
)
