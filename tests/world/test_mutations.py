"""Worlds damaged at random, in bytes, lines, words and structure, are read or refused: never anything else.

Seeded: a failure names its seed, and ``mutated(seed)`` makes the same files again.
"""

from __future__ import annotations

import copy
import io
import random
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml
from PIL import Image

from kit.world.loading import load_world
from kit.world.plugin_reader import PluginReader
from kit.world.problems import WorldError
from kit.world.report import world_report, world_report_data

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

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

WORDS = [
    *(
        "",
        "~",
        "null",
        "no",
        "true",
        "all",
        "0",
        "-1",
        "1e-320",
        "1e309",
        ".nan",
        "-.inf",
        "99999999999999999999",
    ),
    *(
        "[]",
        "{}",
        "[[]]",
        "{a: b}",
        "*color",
        "*nobody",
        "&color x",
        "!!python/object:os.system",
        "!t x",
        "? x",
        "|",
    ),
    *(
        "$include robot.model.yaml",
        "$include more.yaml",
        "$[include] more.yaml",
        "$include ../secret",
        "$eval 1",
    ),
    *("env(HOME)", "env(X, 3)", "param(x)", "..", "/", "/dev/zero", "picture.png", "lines.dat", "world.yaml"),
    *(
        '"\\0"',
        '"\\e[2J"',
        "\u202e",
        "日本語",
        "\ud7ff",
        "x" * 5000,
        "'",
        '"',
        "- ",
        ": ",
        "#",
        "%",
        "---\n",
        "\t",
        "\r",
    ),
]
VALUES: list[Any] = [
    *(
        None,
        True,
        0,
        -1,
        1e-320,
        1e300,
        2**70,
        float("nan"),
        float("inf"),
        "",
        "all",
        "x" * 300,
        "walls",
        "base",
    ),
    *([], {}, [[]], [0] * 20, [[0, 0]] * 4, {"name": "base"}, ["all", "all"], [None], {"type": "circle"}),
]

Files = dict[str, bytes]
Damage = Callable[[random.Random, Files, str], bytes]


def damage_bytes(rng: random.Random, files: Files, name: str) -> bytes:
    """Bytes changed, cut out, put in, or written twice."""
    content = bytearray(files[name])
    for _ in range(rng.randint(1, 5)):
        at = rng.randrange(len(content) + 1)
        some = slice(at, at + rng.randint(0, 8))
        content[some] = rng.choice([rng.randbytes(rng.randint(0, 4)), b"", bytes(content[some]) * 2])
    return bytes(content)


def damage_lines(rng: random.Random, files: Files, name: str) -> bytes:
    """Lines left out, repeated, moved, indented, or taken from another file."""
    lines = files[name].splitlines(keepends=True)
    other = files[rng.choice(sorted(files))].splitlines(keepends=True)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(lines) + 1)
        some = lines[at : at + rng.randint(1, 4)]
        lines[at : at + len(some)] = rng.choice(
            [
                [],
                some * 2,
                some[::-1],
                [b"  " + line for line in some],
                [line.lstrip() for line in some],
                other[:3],
            ]
        )
    return b"".join(lines)


def damage_words(rng: random.Random, files: Files, name: str) -> bytes:
    """A word, a number or a bracket replaced by one that makes trouble."""
    words = files[name].decode("latin-1").replace("[", " [ ").replace("]", " ] ").split(" ")
    for _ in range(rng.randint(1, 3)):
        words[rng.randrange(len(words))] = rng.choice(WORDS)
    return " ".join(words).encode()


def damage_structure(rng: random.Random, files: Files, name: str) -> bytes:
    """Still good YAML, but a key or a value somewhere in it is another one, gone, or there twice."""
    document = next(iter(yaml.load_all(files[name], Loader=LOADER)), None)
    for _ in range(rng.randint(1, 3)):
        places = list(containers(document))
        if not places:
            break
        location = rng.choice(places)
        key = rng.choice(list(location) if isinstance(location, dict) else range(len(location)))
        act = rng.randrange(4)
        if act == 0:
            location[key] = copy.deepcopy(rng.choice(VALUES))
        elif act == 1:
            del location[key]
        elif act == 2 and isinstance(location, dict):
            location[rng.choice(["name", "type", "layers", "nmae", 1, None, "x" * 300])] = location.pop(key)
        else:
            location[key] = [location[key]] * rng.randint(0, 20)
    return yaml.dump(document, Dumper=DUMPER, sort_keys=False, allow_unicode=True).encode()


def containers(value: Any) -> list[Any]:
    """Every mapping and list in the value that is not empty."""
    children = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    inner = [found for child in children for found in containers(child)]
    return [value, *inner] if isinstance(value, dict | list) and value else inner


def mutated(seed: int) -> Files:
    """The files of world number ``seed``: one or two of them damaged, in one way each."""
    rng = random.Random(seed)
    picture = io.BytesIO()
    Image.new("L", (6, 5), 255).save(picture, "PNG")
    files = {name: text.encode() for name, text in FILES.items()} | {"picture.png": picture.getvalue()}
    for _ in range(rng.randint(1, 2)):
        name = rng.choice(sorted(files))
        ways: list[Damage] = [damage_bytes, damage_lines, damage_words]
        if name.endswith(".yaml"):
            ways += [damage_structure] * 3
        way = rng.choice(ways)
        try:
            files[name] = way(rng, files, name)
        except (yaml.YAMLError, ValueError):  # already damaged too much to be changed as YAML
            files[name] = damage_bytes(rng, files, name)
    return files


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
        start = time.perf_counter()
        error = refusal(tmp_path, files, devices)
        assert time.perf_counter() - start < SECONDS, seed
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
