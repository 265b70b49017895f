"""What each key means in a sheet of the kind ``controller``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "trials": "Kinds of episodes",
        "trials.name": "Its name",
        "trials.place": "A map of the kit, or a world file in this folder (then with `target`)",
        "trials.case": "Which start and target of the map",
        "trials.target": "The target [m]; one of its own instead of the map's",
        "trials.target_radius": "How near counts as reached [m]",
        "trials.time": "The time limit in simulated seconds",
        "trials.seeds": "Seeds for practice; those for the grade stand in secret.yaml",
        "trials.shift": "The most that a seed moves the start to either side, along the x and y of the world: m, m, rad",
        "trials.noise": "Standard deviation of every laser's readings [m], by default the world's",
        "trials.range": "Range of every laser [m], by default the world's",
        "trials.until_reached": "Whether the episode ends when the target is reached",
        "trials.services": "The world services that the program may call",
        "trials.topics": "Ground-truth topics that it may read: odometry/ground_truth",
        "trials.parameters": "Parameters that it is started with: name:=value",
        "trials.calls": "Calls that the grader makes to services of the program",
        "trials.calls.name": "What checks call it",
        "trials.calls.at": "When it is made [simulated s]",
        "trials.calls.service": "The service; without a slash in front that of the program's own node, whatever its name",
        "trials.calls.type": "Its type: std_srvs/srv/Trigger",
        "trials.calls.request": "The fields of the request",
        "trials.calls.within": "A later answer counts as none [simulated s]",
        "secret.seeds": "In secret.yaml: seeds for the grade, by the trial's name",
        "secret.seeds.NAME": "Those of one trial; make each with `python3 -c 'import secrets; print(secrets.randbits(62))'`",
    }
)
