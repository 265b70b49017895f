"""Worlds damaged at random, in bytes, lines, words and structure, are read or refused: never anything else.

Seeded: a failure names its seed, and ``mutated(seed)`` makes the same files again.
"""

from __future__ import annotations

import io
import random
import time
from collections.abc import Mapping
from pathlib import Path

import pytest
from PIL import Image

from kit.world.loading import load_world
from kit.world.plugin_reader import PluginReader
from kit.world.problems import WorldError
from kit.world.report import world_report, world_report_data
from tests.fuzz.damage import Files, damage_files

WORLDS = 2000
BATCHES = 20
SECONDS = 5.0
"""For one world; the machine may be busy."""

FILES = {
    "world.yaml": """\
properties: {velocity_iterations: 11, position_iterations: 12}
layers:
  - name: [walls, seen]
    map: picture.yaml
    color: [0, 1, 0, 0.675]
  - name: "lines"
    map: map.yaml
    properties: {height: 2}
models:
  - name: robot1
    model: robot.model.yaml
  - {name: robot2, model: robot.model.yaml, pose: [3, 4.5, 3.14159], namespace: second}
  - $[include] more.yaml
""",
    "more.yaml": "name: robot3\nmodel: robot.model.yaml\n---\nname: env(FOURTH, robot4)\nmodel: robot.model.yaml\n",
    "picture.yaml": "image: picture.png\nresolution: 0.05\norigin: [0.05e0, -5e-2, 1.57]\noccupied_thresh: 0.65\n",
    "map.yaml": "type: line_segments\ndata: lines.dat\nscale: 0.1\norigin: [-1.20, -5, 1.23]\n",
    "lines.dat": "1 2 3 4\n-1 -2 -3 -4\n0.5 0.5 1e1 7\n",
    "robot.model.yaml": """\
bodies:
  - name: base
    pose: [1, 2, 0.5]
    color: &color [1, 1, 0, 0.25]
    linear_damping: 0.1
    footprints:
      - type: circle
        center: [0.01, 0.02]
        radius: 1.777
        layers: [walls, seen]
        density: 0
      - {type: polygon, density: 9, friction: 0.5, points: [[-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]]}
  - name: wheel
    type: dynamic
    color: *color
    footprints:
      - {type: circle, radius: 0.2, density: 1, layers: [], sensor: true, collision: false}
joints:
  - name: axle
    type: weld
    angle: 1.57
    bodies:
      - {name: base, anchor: [-1, 0]}
      - {name: wheel, anchor: [0, 0.5]}
plugins:
  - {type: Laser, name: eye, body: base, range: 5, layers: [seen]}
""",
}


def mutated(seed: int) -> Files:
    """The files of world number ``seed``: one or two of them damaged, in one way each."""
    rng = random.Random(seed)
    picture = io.BytesIO()
    Image.new("L", (6, 5), 255).save(picture, "PNG")
    files = {name: text.encode() for name, text in FILES.items()} | {"picture.png": picture.getvalue()}
    return damage_files(rng, files)


def refusal(folder: Path, files: Files, devices: Mapping[str, PluginReader]) -> WorldError | None:
    """Why the world is refused; None if it is not, and then it can also be described."""
    for name, content in files.items():
        (folder / name).write_bytes(content)
    try:
        world = load_world(folder / "world.yaml", plugin_readers=devices)
    except WorldError as error:
        return error
    assert world_report(world)
    assert world_report_data(world)
    return None


@pytest.mark.long
@pytest.mark.parametrize("batch", range(BATCHES))
def test_a_damaged_world_is_read_or_refused(
    batch: int, tmp_path: Path, devices: Mapping[str, PluginReader]
) -> None:
    refused = 0
    seeds = range(batch, WORLDS, BATCHES)
    for seed in seeds:
        files = mutated(seed)
        start = time.process_time()
        error = refusal(tmp_path, files, devices)
        assert time.process_time() - start < SECONDS, seed
        if error is not None:
            refused += 1
            assert error.problems, seed
            assert all(problem.location.file.is_relative_to(tmp_path) for problem in error.problems), seed
            assert str(error).encode(), seed
    assert 0.5 < refused / len(seeds) < 1


def test_the_world_that_is_damaged_is_sound(tmp_path: Path, devices: Mapping[str, PluginReader]) -> None:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    Image.new("L", (6, 5), 255).save(tmp_path / "picture.png")
    assert len(load_world(tmp_path / "world.yaml", plugin_readers=devices).models) == 4
