"""What each key means in a sheet of the kind ``environment``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "environment": "What the environment must be like",
        "environment.task": "A task instead of a place",
        "environment.place": "A map of the kit",
        "environment.case": "Which start and target of the map",
        "environment.target": "The target [m]; one of its own instead of the map's",
        "environment.target_radius": "How near counts as reached [m]",
        "environment.moves": "What each action drives: m/s, rad/s",
        "environment.step_time": "Simulated seconds of a step",
        "environment.max_steps": "Steps after which an episode is truncated",
        "environment.clip": "What is farther away is not seen [m]",
        "environment.class": "The name of the class",
        "environment.way": "Points on the way to the target [m]",
        "environment.scan": "The topic of the laser",
        "seed": "Of the episodes, for practice",
        "secret.seed": "In secret.yaml: that for the grade",
    }
)
