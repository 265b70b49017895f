"""What a simulation can be told besides messages, by name and with plain arguments: services and replays share it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from kit.geometry import Pose
from kit.sim.simulation import Simulation


def _move(simulation: Simulation, name: str, pose: Sequence[float]) -> None:
    simulation.move_model(name, Pose(*pose))


def _spawn(simulation: Simulation, file: str, name: str, namespace: str, pose: Sequence[float]) -> None:
    simulation.spawn_model(Path(file), name, namespace, Pose(*pose))


SERVICES: Final[Mapping[str, Callable[..., None]]] = MappingProxyType(
    {
        "move_model": _move,
        "spawn_model": _spawn,
        "delete_model": Simulation.delete_model,
        "reset": Simulation.reset,
    }
)
"""Each takes the simulation, then arguments that JSON can hold."""


def tell(simulation: Simulation, service: str, *arguments: Any) -> None:
    """Has the simulation do it. Raises KeyError for an unknown service, SimulationError if it cannot be done."""
    SERVICES[service](simulation, *arguments)
