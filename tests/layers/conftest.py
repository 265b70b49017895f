"""Flatland worlds for the tests of this folder, written where each test may change them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

WriteFiles = Callable[[Mapping[str, str | bytes]], Path]

MAP = "type: line_segments\ndata: lines.dat\nscale: 1\norigin: [0, 0, 0]\n"

YARD = {
    "world.yaml": """\
# The yard. Six names, and fewer would do.
properties: {}

layers:
  - name: [solid, seen, both]     # what robots touch, what lasers see
    map: map.yaml
  - name: fence             # outside
    map: map.yaml
  - name: tracked           # robots only, for the beacon
  - name: spare

models:
  - {name: robot, model: robot.model.yaml, pose: [1, 1, 0]}
  - name: chair1
    model: chair.model.yaml
  - name: chair2
    model: chair.model.yaml
    pose: [2, 2, 0]
  - name: beacon
    model: beacon.model.yaml
""",
    "map.yaml": MAP,
    "lines.dat": "0 0 9 0\n9 0 9 9\n",
    "robot.model.yaml": """\
bodies:
  - name: base              # the hull
    footprints:
      - type: circle        # around the laser
        radius: 0.2
        density: 1
        layers: [solid, both, tracked]
  - name: bumper
    footprints:
      - {type: circle, center: [0.3, 0], radius: 0.05, density: 1, layers: [solid, both, tracked]}  # in front

joints:
  - {name: fix, type: weld, bodies: [{name: base, anchor: [0, 0]}, {name: bumper, anchor: [0, 0]}]}

plugins:
  - type: DiffDrive
    name: drive
    body: base
  - type: Laser
    name: lidar
    body: base
    range: 10
    angle: {min: -3, max: 3, increment: 0.1}
    layers:
      - seen    # walls
""",
    "chair.model.yaml": """\
bodies:
  - name: seat
    footprints:
      - type: circle
        radius: 0.2
        density: 1
        layers: ["both", "fence"]   # not the robot's
""",
    "beacon.model.yaml": """\
bodies:
  - name: post
    type: static
    footprints:
      - {type: circle, radius: 0.1, density: 0, layers: []}
plugins:
  - {type: Laser, name: eye, body: post, range: 5, angle: {min: 0, max: 1, increment: 0.1}, layers: [tracked]}
""",
}
"""A world with most of what matters: two maps, a laser inside its body, copies, a free and a spare layer."""


@pytest.fixture
def write(tmp_path: Path) -> WriteFiles:
    """Writes files into a folder of their own, over those of the yard; gives the world file."""

    def write(files: Mapping[str, str | bytes]) -> Path:
        folder = tmp_path / "yard"
        for name, content in {**YARD, **files}.items():
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return folder / "world.yaml"

    return write


@pytest.fixture
def yard(write: WriteFiles) -> Path:
    return write({})
