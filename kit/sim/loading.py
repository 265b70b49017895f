"""World and model files, read with the devices that this simulation has."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from kit.geometry import Pose
from kit.sim.plugins import readers, world_readers
from kit.world import loading
from kit.world.records import Model, World


def load(
    path: Path | str, *, root: Path | None = None, environment: Mapping[str, str] | None = None
) -> World:
    """The world that a file describes, ready to be simulated. Arguments and errors are those of ``load_world``."""
    return loading.load_world(
        Path(path), devices=readers, world_devices=world_readers, root=root, environment=environment
    )


def load_model(path: Path | str, world: World, *, name: str, namespace: str, pose: Pose) -> Model:
    """The model that a file describes, for a world that is already there. Errors are those of ``load_world``."""
    return loading.load_model(
        Path(path),
        name=name,
        namespace=namespace,
        pose=pose,
        layer_bits=world.layer_bits,
        devices=readers,
    )
