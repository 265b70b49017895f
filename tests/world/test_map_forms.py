"""Maps as people have them: what ROS's map_server says of a grey level, and what the kit makes of it.

Sources: nav2_map_server's ``map_io.cpp`` (loadMapFromFile) and its README; wiki.ros.org/map_server, "Value Interpretation".
The kit's threshold is Flatland's: a pixel is a wall below ``occupied_thresh`` of white. Both agree wherever map_server
says occupied or free, and a level that it calls unknown may be either.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kit.world.layer_reader import MODES, wall_pixels
from kit.world.loading import load_world
from kit.world.problems import WorldError
from tests.cases import every_case

OCCUPIED, FREE, UNKNOWN = 100, 0, -1

FACTS = [
    # mode, negate, occupied_thresh, free_thresh, grey level, what map_server publishes
    ("trinary", 0, 0.65, 0.196, 0, OCCUPIED),
    ("trinary", 0, 0.65, 0.196, 89, OCCUPIED),
    ("trinary", 0, 0.65, 0.196, 90, UNKNOWN),
    ("trinary", 0, 0.65, 0.196, 205, UNKNOWN),
    ("trinary", 0, 0.65, 0.196, 206, FREE),
    ("trinary", 0, 0.65, 0.25, 192, FREE),
    ("trinary", 0, 0.65, 0.196, 254, FREE),
    ("trinary", 0, 0.9, 0.1, 25, OCCUPIED),
    ("trinary", 0, 0.9, 0.1, 230, FREE),
    ("trinary", 1, 0.65, 0.196, 255, OCCUPIED),
    ("trinary", 1, 0.65, 0.196, 166, OCCUPIED),
    ("trinary", 1, 0.65, 0.196, 165, UNKNOWN),
    ("trinary", 1, 0.65, 0.196, 49, FREE),
    ("trinary", 1, 0.65, 0.196, 0, FREE),
    ("scale", 0, 0.65, 0.196, 89, OCCUPIED),
    ("scale", 0, 0.65, 0.196, 206, FREE),
    ("scale", 0, 0.65, 0.196, 128, 66),
    ("scale", 1, 0.65, 0.196, 200, OCCUPIED),
    ("raw", 0, 0.65, 0.196, 0, FREE),
    ("raw", 0, 0.65, 0.196, 40, 40),
    ("raw", 0, 0.65, 0.196, 100, OCCUPIED),
    ("raw", 0, 0.65, 0.196, 101, UNKNOWN),
    ("raw", 0, 0.65, 0.196, 255, UNKNOWN),
]


def published(mode: str, negate: int, occupied: float, free: float, level: int) -> int:
    """The documented formula."""
    if mode == "raw":
        return level if level <= 100 else UNKNOWN
    share = level / 255 if negate else (255 - level) / 255
    if share > occupied:
        return OCCUPIED
    if share < free:
        return FREE
    return UNKNOWN if mode == "trinary" else round(99 * (share - free) / (occupied - free))


@every_case(("mode", "negate", "occupied", "free", "level", "value"), FACTS)
def test_what_is_occupied_is_a_wall_and_what_is_free_is_none(
    mode: str, negate: int, occupied: float, free: float, level: int, value: int
) -> None:
    assert published(mode, negate, occupied, free, level) == value
    grey = np.array([[level]], dtype=np.uint8)
    is_wall = bool(wall_pixels(grey, occupied, negate=bool(negate), mode=MODES[mode])[0, 0])
    if value in (OCCUPIED, FREE) or mode == "raw":
        assert is_wall == (value > 100 * occupied)


def world(folder: Path, map_text: str, *, name: str = "rgb.png", alpha: int = 255) -> Path:
    """A world with a picture of one dark pixel, transparent by ``alpha``, in a light 5 x 5."""
    picture = np.full((5, 5, 4), 255, dtype=np.uint8)
    picture[2, 2] = (0, 0, 0, alpha)
    Image.fromarray(picture).save(folder / name)
    (folder / "m.yaml").write_text(f"resolution: 1\norigin: [0, 0, 0]\n{map_text}\n")
    (folder / "world.yaml").write_text("properties: {}\nlayers: [{name: static, map: m.yaml}]\nmodels: []\n")
    return folder / "world.yaml"


def segments(file: Path) -> int:
    (layer,) = load_world(file).layers
    assert layer.walls is not None
    return len(layer.walls.segments)


@every_case(
    ("keys", "alpha", "count"),
    [
        ("", 255, 4),
        ("mode: trinary", 0, 4),  # transparency is ignored
        ("mode: scale", 255, 4),
        ("mode: scale", 0, 0),  # nothing is known there
        ("negate: 1", 255, 8),  # the light rim, outside and inside
        ("negate: true", 255, 8),
        ("negate: 0\nfree_thresh: 0.196", 255, 4),
        ("mode: raw", 255, 0),  # 0 is free, 255 unknown
    ],
)
def test_the_keys_of_map_server_are_followed(tmp_path: Path, keys: str, alpha: int, count: int) -> None:
    file = world(tmp_path, f"image: rgb.png\noccupied_thresh: 0.65\n{keys}", alpha=alpha)
    assert segments(file) == count


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
        ("occupied_thresh: 0.65\nmode: trinery", ["trinary"]),
        ("occupied_thresh: 0.65\nnegate: 2", ["negate"]),
    ],
)
def test_one_mistake_is_one_sentence_about_the_right_key(tmp_path: Path, keys: str, said: list[str]) -> None:
    file = world(tmp_path, f"image: rgb.png\n{keys}")
    with pytest.raises(WorldError) as caught:
        load_world(file)
    (problem,) = caught.value.problems
    assert all(each in problem.message for each in said)
    assert "not used here" not in problem.message
