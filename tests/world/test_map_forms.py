"""Maps as people have them: what ROS's map_server makes of a picture, what the kit makes of it, and that a difference is said.

Sources of the table: nav2_map_server's ``map_io.cpp`` (loadMapYaml, loadMapFromFile) and wiki.ros.org/map_server. The kit
reads as Flatland does: a pixel is a wall below ``occupied_thresh`` of white; ``free_thresh``, ``negate`` and ``mode`` are
read by nobody there.
"""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kit.world.layer_reader import dark_pixels
from kit.world.loading import load_world
from kit.world.map_server import (
    FREE,
    MODES,
    OCCUPIED,
    UNKNOWN,
    MapMode,
    MapServerKeys,
    count_read_otherwise,
    occupancy,
)
from kit.world.problems import WorldError
from kit.world.records import World
from tests.cases import every_case

FACTS = [
    # mode, negate, occupied_thresh, free_thresh, grey level, opacity (None: the picture has none), the cell, a wall in Flatland
    ("trinary", 0, 0.65, 0.196, 0, None, OCCUPIED, True),
    ("trinary", 0, 0.65, 0.196, 89, None, OCCUPIED, True),
    ("trinary", 0, 0.65, 0.196, 90, None, UNKNOWN, True),
    ("trinary", 0, 0.65, 0.196, 165, None, UNKNOWN, True),
    ("trinary", 0, 0.65, 0.196, 166, None, UNKNOWN, False),
    ("trinary", 0, 0.65, 0.196, 205, None, UNKNOWN, False),
    ("trinary", 0, 0.65, 0.196, 206, None, FREE, False),
    ("trinary", 0, 0.65, 0.25, 192, None, FREE, False),
    ("trinary", 0, 0.65, 0.196, 254, None, FREE, False),
    # at a threshold exactly: neither occupied nor free
    ("trinary", 0, 0.8, 0.2, 51, None, UNKNOWN, True),
    ("trinary", 1, 0.8, 0.2, 51, None, UNKNOWN, True),
    # pairs for which the two readings contradict each other
    ("trinary", 0, 0.4, 0.3, 120, None, OCCUPIED, False),
    ("trinary", 0, 0.1, 0.05, 200, None, OCCUPIED, False),
    ("trinary", 0, 0.9, 0.8, 100, None, FREE, True),
    ("trinary", 0, 0.65, 0.5, 150, None, FREE, True),
    ("trinary", 0, 1.0, 0.25, 0, None, UNKNOWN, True),
    ("trinary", 1, 0.65, 0.196, 255, None, OCCUPIED, False),
    ("trinary", 1, 0.65, 0.196, 166, None, OCCUPIED, False),
    ("trinary", 1, 0.65, 0.196, 165, None, UNKNOWN, True),
    ("trinary", 1, 0.65, 0.196, 49, None, FREE, True),
    ("trinary", 1, 0.65, 0.196, 0, None, FREE, True),
    # opacity counts as a fourth colour
    ("trinary", 0, 0.65, 0.196, 0, 255, OCCUPIED, True),
    ("trinary", 0, 0.8, 0.196, 0, 255, UNKNOWN, True),
    ("trinary", 0, 0.65, 0.196, 255, 0, UNKNOWN, False),
    ("scale", 0, 0.65, 0.196, 89, None, OCCUPIED, True),
    ("scale", 0, 0.65, 0.196, 206, None, FREE, False),
    ("scale", 0, 0.65, 0.196, 128, None, 67, True),
    ("scale", 1, 0.65, 0.196, 200, None, OCCUPIED, False),
    ("scale", 0, 0.65, 0.196, 0, 254, UNKNOWN, True),
    ("scale", 0, 0.65, 0.196, 0, 255, OCCUPIED, True),
    ("raw", 0, 0.65, 0.196, 0, None, FREE, True),
    ("raw", 0, 0.65, 0.196, 40, None, 40, True),
    ("raw", 0, 0.65, 0.196, 100, None, OCCUPIED, True),
    ("raw", 0, 0.65, 0.196, 101, None, UNKNOWN, True),
    ("raw", 1, 0.65, 0.196, 255, None, UNKNOWN, False),
]


@every_case(("mode", "negate", "occupied", "free", "level", "opacity", "cell", "is_wall"), FACTS)
def test_each_fact(
    mode: str,
    negate: int,
    occupied: float,
    free: float,
    level: int,
    opacity: int | None,
    cell: int,
    is_wall: bool,
) -> None:
    grey = np.array([[level]], dtype=np.uint8)
    alpha = None if opacity is None else np.array([[opacity]], dtype=np.uint8)
    keys = MapServerKeys(occupied, free, bool(negate), MODES[mode])
    assert occupancy(grey, alpha, keys)[0, 0] == cell
    dark = dark_pixels(grey, occupied)
    assert bool(dark[0, 0]) == is_wall
    contradict = (cell == OCCUPIED and not is_wall) or (cell == FREE and is_wall)
    assert count_read_otherwise(dark, grey, alpha, keys) == contradict


@every_case("mode", ["trinary", "scale", "raw"])
@every_case("is_clear", [False, True])
def test_of_a_picture_each_pixel_counts_and_few_bytes_are_taken_for_it(mode: MapMode, is_clear: bool) -> None:
    rng = np.random.default_rng(1)
    grey, alpha = (rng.integers(0, 256, (300, 400), dtype=np.uint8) for _ in range(2))
    opacity = alpha if is_clear else None
    keys = MapServerKeys(0.65, 0.196, mode=mode)
    dark = dark_pixels(grey, 0.5)
    cells = occupancy(grey, opacity, keys)
    expected = np.count_nonzero((dark & (cells == FREE)) | (~dark & (cells == OCCUPIED)))
    tracemalloc.start()
    assert count_read_otherwise(dark, grey, opacity, keys) == expected
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 5_000_000 + 8 * grey.size


def world(folder: Path, map_text: str, *, name: str = "rgb.png", alpha: int = 255) -> Path:
    """A world with a picture of one dark pixel, transparent by ``alpha``, in a light 5 x 5."""
    picture = np.full((5, 5, 4), 255, dtype=np.uint8)
    picture[2, 2] = (0, 0, 0, alpha)
    Image.fromarray(picture).save(folder / name)
    resolution = "" if "resolution" in map_text else "resolution: 1\n"
    (folder / "m.yaml").write_text(f"{resolution}origin: [0, 0, 0]\n{map_text}\n")
    (folder / "world.yaml").write_text("properties: {}\nlayers: [{name: static, map: m.yaml}]\nmodels: []\n")
    return folder / "world.yaml"


def loaded(file: Path) -> tuple[World, int]:
    """The world, and how many walls it has."""
    world = load_world(file)
    (layer,) = world.layers
    assert layer.walls is not None
    return world, len(layer.walls.segments)


@every_case(
    ("keys", "alpha", "line"),
    [
        ("occupied_thresh: 0.65", 255, None),
        ("occupied_thresh: 0.65\nmode: trinary\nnegate: 0\nfree_thresh: 0.196", 255, None),
        ("occupied_thresh: 0.65\nmode: scale", 255, None),  # black and white mean the same in both modes
        ("occupied_thresh: 0.65\nmode: scale", 0, None),  # unknown there: neither occupied nor free
        ("occupied_thresh: 0.65\nnegate: 1", 255, 5),
        ("occupied_thresh: 0.65\nnegate: true", 255, 5),
        ("occupied_thresh: 0.65\nnegate: 2", 255, 5),
        ("occupied_thresh: 0.65\nnegate: -1", 255, 5),
        ("occupied_thresh: 0.65\nnegate: 00", 255, None),
        ("occupied_thresh: 0.65\nmode: raw", 255, 5),
        ("occupied_thresh: 0.65\nfree_thresh: 0.9\nmode: Raw", 255, 6),
        ("occupied_thresh: 0.65\nfree_thresh: junk\nnegate: junk", 255, None),
        ("occupied_thresh: 0.65\nfree_thresh: 25", 255, 5),
        ("occupied_thresh: 0.65\nmode: junk", 255, 5),
        ("occupied_thresh: 0.65\nresolution: 20", 255, 4),
    ],
)
def test_a_picture_is_read_as_flatland_reads_it_and_a_difference_is_said_with_its_line(
    tmp_path: Path, keys: str, alpha: int, line: int | None
) -> None:
    found, walls = loaded(world(tmp_path, f"image: rgb.png\n{keys}", alpha=alpha))
    assert walls == 4
    assert [remark.location.line for remark in found.remarks] == ([] if line is None else [line])


def test_a_heading_that_looks_like_degrees_is_said(tmp_path: Path) -> None:
    file = world(tmp_path, "image: rgb.png\noccupied_thresh: 0.65")
    (tmp_path / "bot.yaml").write_text(
        "bodies: [{name: b, footprints: [{type: circle, radius: 0.1, density: 1}]}]\n"
    )
    for heading, count in (("90", 1), ("-7", 1), ("1.57", 0), ("-6.28", 0)):
        text = "properties: {}\nlayers: []\nmodels:\n- {name: bot, model: bot.yaml, pose: [0, 0, %s]}\n"
        file.write_text(text % heading)
        remarks = load_world(file).remarks
        assert len(remarks) == count
        assert all(remark.location.line == 4 and heading in remark.message for remark in remarks)


def test_an_origin_and_a_body_that_look_turned_by_degrees_are_said(tmp_path: Path) -> None:
    file = world(tmp_path, "image: rgb.png\noccupied_thresh: 0.65")
    (tmp_path / "m.yaml").write_text(
        "image: rgb.png\nresolution: 1\norigin: [0, 0, 90]\noccupied_thresh: 0.65\n"
    )
    (tmp_path / "bot.yaml").write_text(
        "bodies:\n- {name: arm, pose: [0, 0, -45], footprints: [{type: circle, radius: 0.1, density: 1}]}\n"
    )
    models = "models: [{name: a, model: bot.yaml}, {name: b, model: bot.yaml}]"
    file.write_text(f"properties: {{}}\nlayers: [{{name: static, map: m.yaml}}]\n{models}\n")
    said = [(remark.location.file.name, remark.location.line) for remark in load_world(file).remarks]
    assert said == [("m.yaml", 3), ("bot.yaml", 2)]


@pytest.mark.parametrize(
    ("image", "near"),
    [
        ("RGB.PNG", "rgb.png"),
        ("./Rgb.png", "rgb.png"),
        ("maps\\\\rgb.png", "rgb.png"),
        ("C:\\\\Users\\\\ada\\\\rgb.png", "rgb.png"),
        ("~/map/rgb.png", "rgb.png"),
        ("file:///home/ada/rgb.png", "rgb.png"),
        ("/home/ada/ws/rgb.png", "rgb.png"),
        ("other.png", ""),
    ],
)
def test_a_picture_that_is_named_as_elsewhere_gets_the_near_name(
    tmp_path: Path, image: str, near: str
) -> None:
    file = world(tmp_path, f'image: "{image}"\noccupied_thresh: 0.65')
    with pytest.raises(WorldError) as caught:
        load_world(file)
    (problem,) = caught.value.problems
    assert problem.location.line == 3
    assert (f'Did you mean "{near}"?' in problem.message) == bool(near)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("free_thresh: 0.196", ["occupied_thresh"]),  # and not that free_thresh is meant to be that
        ("occupied_thresh: 65", ["0.65"]),
        ("occupied_thresh: 0,65", ["occupied_thresh"]),
    ],
)
def test_one_mistake_is_one_sentence_about_the_right_key(tmp_path: Path, keys: str, said: list[str]) -> None:
    file = world(tmp_path, f"image: rgb.png\n{keys}")
    with pytest.raises(WorldError) as caught:
        load_world(file)
    (problem,) = caught.value.problems
    assert all(each in problem.message for each in said)
    assert "not used here" not in problem.message
