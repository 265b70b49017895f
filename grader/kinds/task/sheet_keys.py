"""What each key means in a sheet of the kind ``task``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "task": "How the task is examined",
        "task.algorithm": "What trains on it",
        "task.steps": "Steps of a training",
        "task.trainings": "How many trainings",
        "task.episodes": "Episodes of a test",
        "task.policy": "A policy that is handed in beside the task, by its file name",
        "seed": "Of the trainings, for practice",
        "secret.seed": "In secret.yaml: that for the grade",
    }
)
