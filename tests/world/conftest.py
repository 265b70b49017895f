"""Worlds for the tests of this folder, and readers for the two plugins that they use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from kit.geometry import Pose
from kit.world.plugin_reader import ModelScope, PluginReader, WorldPluginReader, WorldScope
from kit.world.records import LaserMount
from kit.world.yaml_section import Section

WriteFiles = Callable[[Mapping[str, str | bytes]], Path]

WALLED = {
    "world.yaml": """\
properties: {}
layers:
  - {name: walls, map: map.yaml}
models:
  - {name: robot, model: robot.model.yaml}
""",
    "map.yaml": "type: line_segments\ndata: lines.dat\nscale: 1\norigin: [0, 0, 0]\n",
    "lines.dat": "0 0 4 0\n4 0 4 3\n",
    "robot.model.yaml": """\
bodies:
  - name: base
    footprints:
      - {type: circle, radius: 0.1, density: 1}
""",
}


@pytest.fixture
def write(tmp_path: Path) -> WriteFiles:
    """Writes files into a folder of their own, over those of a small sound world; gives its world file."""

    def write(files: Mapping[str, str | bytes]) -> Path:
        folder = tmp_path / "world"
        for name, content in {**WALLED, **files}.items():
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return folder / "world.yaml"

    return write


@dataclass(frozen=True)
class Eye:
    """What the tests' laser keeps of its parameters."""

    mount: LaserMount
    range: float


@dataclass(frozen=True)
class Builder:
    """What the tests' world plugin keeps of its parameters."""

    layer: str
    model: str


def _read_eye(section: Section, scope: ModelScope) -> Eye:
    mount = LaserMount(scope.body(section, "body"), scope.layers(section), section.pose("origin", Pose()))
    return Eye(mount, section.number("range", above=0))


def _read_builder(section: Section, scope: WorldScope) -> Builder:
    return Builder(scope.layer(section, "layer"), scope.model(section, "robot_name"))


@pytest.fixture
def devices() -> Mapping[str, PluginReader]:
    return {"Laser": _read_eye}


@pytest.fixture
def world_devices() -> Mapping[str, WorldPluginReader]:
    return {"RandomWall": _read_builder}
