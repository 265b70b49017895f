"""What each key means in a sheet of the kind ``world``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "trials": "Drives in the world that is handed in",
        "trials.name": "Its name",
        "trials.driver": "The node that drives; a file in this folder",
        "trials.robot": "The model that is driven, by default the first that can drive",
        "trials.target": "The target [m]",
        "trials.target_radius": "How near counts as reached [m]",
        "trials.time": "The time limit in simulated seconds",
        "trials.until_reached": "Whether the episode ends when the target is reached",
        "trials.seeds": "Seeds for practice; those for the grade stand in secret.yaml",
        "secret.seeds": "In secret.yaml: seeds for the grade, by the trial's name",
        "secret.seeds.NAME": "Those of one trial",
    }
)
