"""The dissertation's maps have its dimensions, and every picture is what its plan draws."""

from __future__ import annotations

import math
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from numpy.typing import NDArray
from PIL import Image

from kit.arrays import BoolArray
from kit.geometry import Pose
from kit.world.catalogue import find_map, maps_folder
from kit.world.loading import load_world
from kit.world.records import Polygon, Walls
from tests.cases import every_case
from tests.kit_content import kit_maps

DRAW = runpy.run_path(str(Path(__file__).with_name("draw.py")))
MAPS = maps_folder()

# Pixels, metres per pixel, origin: the dissertation's pictures.
PICTURES = {
    "maze": ((330, 207), 0.025, Pose(-0.8, -4.2)),
    "simple": ((330, 207), 0.025, Pose(-4.5, -2.6)),
    "racetrack": ((710, 375), 0.013, Pose(-0.46, -2.0)),
    "house": ((800, 619), 0.01, Pose(-4.2, -3.35)),
    "turn": ((60, 60), 0.04, Pose(-0.5, -0.3)),
    "hall_turn_90": ((60, 60), 0.05, Pose()),
    "hall_turn_180": ((48, 60), 0.05, Pose()),
} | {
    f"hall_{name}": ((25, 60), 0.05, Pose())
    for name in (
        *("straight", "left_door", "center_door", "right_door", "two_doors"),
        *("small_obstacle", "large_obstacle"),
    )
}

Block = tuple[float, float, float, float]
LEG: Block = (0.10, 0.10, 1.15, 2.90)

# Where a robot may be, and what stands in it: left, bottom, right, top [m].
SPACES: dict[str, tuple[list[Block], list[Block]]] = {
    "turn": ([(-0.42, -0.22, 0.42, 2.02), (-0.42, 1.22, 1.82, 2.02)], []),
    "hall_straight": ([LEG], []),
    "hall_left_door": ([LEG], [(0.45, 1.40, 1.15, 1.50)]),
    "hall_center_door": ([LEG], [(0.10, 1.40, 0.45, 1.50), (0.80, 1.40, 1.15, 1.50)]),
    "hall_right_door": ([LEG], [(0.10, 1.40, 0.80, 1.50)]),
    "hall_two_doors": (
        [LEG],
        [(0.10, 1.40, 0.20, 1.50), (0.55, 1.40, 0.70, 1.50), (1.05, 1.40, 1.15, 1.50)],
    ),
    "hall_small_obstacle": ([LEG], [(0.55, 1.30, 0.70, 1.60)]),
    "hall_large_obstacle": ([LEG], [(0.45, 1.30, 0.80, 1.60)]),
    "hall_turn_90": ([LEG, (0.10, 1.90, 2.90, 2.90)], []),
    "hall_turn_180": ([LEG, (1.25, 0.10, 2.30, 2.90), (0.10, 1.90, 2.30, 2.90)], []),
}

# The straight walls of the two curves, and the two arcs: x, y, radius [m].
CURVES: dict[str, tuple[list[Block], list[tuple[float, float, float]]]] = {
    "hall_curve_90": (
        [
            *((0.10, 0.10, 0.10, 1.50), (0.10, 0.10, 1.15, 0.10), (1.15, 0.10, 1.15, 1.50)),
            *((1.60, 1.90, 2.90, 1.90), (2.90, 1.90, 2.90, 2.90), (1.50, 2.90, 2.90, 2.90)),
        ],
        [(1.5, 1.5, 1.4), (1.6, 1.5, 0.45)],
    ),
    "hall_curve_180": (
        [
            *((0.10, 0.10, 0.10, 1.50), (0.10, 0.10, 1.15, 0.10), (1.15, 0.10, 1.15, 1.50)),
            *((1.85, 0.10, 1.85, 1.50), (1.85, 0.10, 2.90, 0.10), (2.90, 0.10, 2.90, 1.50)),
        ],
        [(1.5, 1.5, 1.4), (1.5, 1.5, 0.45)],
    ),
}

CASES = {
    "": ["straight"],
    "doors": ["left_door", "center_door", "right_door"],
    "obstacles": ["two_doors", "small_obstacle", "large_obstacle"],
    "90_turns": ["turn_left_90", "turn_right_90", "curve_left_90", "curve_right_90"],
    "180_turns": ["turn_left_180", "turn_right_180", "curve_left_180", "curve_right_180"],
}


def walls(name: str) -> Walls:
    found = [layer.walls for layer in load_world(find_map(name).world_file, root=MAPS).layers if layer.walls]
    assert len(found) == 1
    return found[0]


def inside(x: NDArray[np.floating[Any]], y: NDArray[np.floating[Any]], blocks: list[Block]) -> BoolArray:
    within = [(left < x) & (x < right) & (bottom < y) & (y < top) for left, bottom, right, top in blocks]
    return np.asarray(np.logical_or.reduce(within, initial=False), dtype=np.bool_)


@pytest.mark.long_cases("racetrack")
@pytest.mark.parametrize("name", DRAW["PLANS"])
def test_a_picture_is_what_its_plan_draws(name: str) -> None:
    with Image.open(MAPS / name / "map.png") as shipped:
        assert shipped.mode == "L"
        assert np.array_equal(np.asarray(shipped), np.asarray(DRAW["picture"](name)))


@every_case("name", DRAW["LINE_FILES"])
def test_a_line_file_is_what_its_plan_draws(name: str) -> None:
    assert (MAPS / name / "map.dat").read_text(encoding="utf-8") == DRAW["LINE_FILES"][name]


def test_every_picture_and_line_file_has_a_plan() -> None:
    assert {file.parent.name for file in MAPS.glob("*/*.png")} == set(DRAW["PLANS"])
    assert {file.parent.name for file in MAPS.glob("*/*.dat")} == set(DRAW["LINE_FILES"])


@pytest.mark.long_cases("hall_turn_180")
@pytest.mark.parametrize("name", PICTURES)
def test_the_picture_has_the_dissertations_size(name: str) -> None:
    size, resolution, origin = PICTURES[name]
    with Image.open(walls(name).drawing_file) as image:
        assert image.size == size
    layer = yaml.safe_load(walls(name).file.read_text(encoding="utf-8"))
    assert layer["resolution"] == resolution
    assert walls(name).origin == origin


@every_case("name", SPACES)
def test_square_walls_stand_where_they_must(name: str) -> None:
    """Pixel by pixel: free inside, and wall all around for the thickness of a wall."""
    rooms, things = SPACES[name]
    (columns, rows), pixel, origin = PICTURES[name]
    x = origin.x + pixel * (np.arange(columns)[None, :] + 0.5)
    y = origin.y + pixel * (rows - np.arange(rows)[:, None] - 0.5)
    free = inside(x, y, rooms) & ~inside(x, y, things)
    thick = 0.08 if name == "turn" else 0.10
    grown = [(a - thick, b - thick, c + thick, d + thick) for a, b, c, d in rooms]
    with Image.open(MAPS / name / "map.png") as image:
        dark = np.asarray(image) < 128
    assert np.array_equal(dark, inside(x, y, grown) & ~free)


@pytest.mark.parametrize("name", CURVES)
def test_curved_walls_stand_where_they_must(name: str) -> None:
    straight, arcs = CURVES[name]
    ends = walls(name).segments.round(9)
    drawn = {frozenset((tuple(end[:2]), tuple(end[2:]))) for end in ends.tolist()}
    assert {frozenset(((a, b), (c, d))) for a, b, c, d in straight} <= drawn
    for x, y, radius in arcs:
        far = np.hypot(ends[:, 0::2] - x, ends[:, 1::2] - y)
        pieces = ends[(np.abs(far - radius) < 1e-4).all(axis=1)]
        length = np.hypot(pieces[:, 2] - pieces[:, 0], pieces[:, 3] - pieces[:, 1]).sum()
        assert length == pytest.approx(radius * math.pi / (2 if name.endswith("90") else 1), rel=2e-3)


def test_the_fifteen_cases_of_the_hallway_study() -> None:
    found: dict[str, list[str]] = {}
    for card in kit_maps():
        if card.name.startswith("hall_"):
            for case in card.cases:
                found.setdefault(case.group, []).append(case.name)
                assert case.is_heading_random
                assert case.target_radius == 0.25
                assert sorted(case.start_shift) == sorted(case.target_shift) == [0, 0.3]
    assert {group: sorted(names) for group, names in found.items()} == {
        group: sorted(names) for group, names in CASES.items()
    }


def test_left_is_right_driven_the_other_way() -> None:
    for kind in ("turn_{}_90", "curve_{}_90", "turn_{}_180", "curve_{}_180"):
        card = find_map(f"hall_{kind.replace('{}_', '')}")
        left, right = (
            next(c for c in card.cases if c.name == kind.format(side)) for side in ("left", "right")
        )
        assert left.start[:2] == right.target
        assert right.start[:2] == left.target
        assert left.start_shift == right.target_shift


def test_tutorial_1_needs_two_layers_and_tutorial_2_three() -> None:
    counts = {
        name: len(load_world(find_map(name).world_file, root=MAPS).layer_bits) for name in ("maze", "turn")
    }
    assert counts == {"maze": 2, "turn": 3}


def test_the_robot_has_the_dissertations_measures() -> None:
    serp = load_world(find_map("maze").world_file, root=MAPS).models[0]
    (body,) = serp.bodies
    corners = [
        corner for each in body.footprints if isinstance(each.shape, Polygon) for corner in each.shape.points
    ]
    x, y = zip(*corners, strict=True)
    assert (min(x), max(x)) == (-0.117, 0.048)
    assert (min(y), max(y)) == (-0.085, 0.085)
    assert max(math.hypot(*corner) for corner in corners) == pytest.approx(0.129, abs=5e-4)
