"""What each key means in a sheet of the kind ``launch``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "launch": "What is launched",
        "launch.package": "The folder of the package in which the launch file is put",
        "launch.runs": "How it is launched",
        "launch.runs.name": "The run's name",
        "launch.runs.time": "How long it runs [simulated s]",
        "launch.runs.arguments": "Launch arguments",
        "launch.runs.arguments.NAME": "One argument",
        "secret.runs": "In secret.yaml: further runs, for the grade",
        "secret.runs.name": "The run's name",
        "secret.runs.time": "How long it runs [simulated s]",
        "secret.runs.arguments": "Launch arguments",
        "secret.runs.arguments.NAME": "One argument",
    }
)
