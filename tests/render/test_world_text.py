"""The world in words: distances and sides that a listener can drive by."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.geometry import Pose
from kit.render.clearance import nearest_wall
from kit.render.scene import Disc, Scene, SceneBody
from kit.render.world_text import describe_scene, scene_rows
from tests.cases import every_case
from tests.render.scenes import BOXES, maze, robot

WALL_RIGHT = np.array([(-5.0, -0.485, 5.0, -0.485)])  # 0.4 m beside the right wheel of a robot at the origin


def test_a_robot_with_a_target_and_a_wall() -> None:
    target = Disc(2.1 * math.cos(math.radians(30)), 2.1 * math.sin(math.radians(30)), 0.25)
    scene = Scene(WALL_RIGHT, (robot(Pose()),), targets=(target,))
    assert describe_scene(scene) == "target 2.1 m at +30 deg; nearest wall 0.4 m right"


@every_case(
    ("degrees", "side"),
    [(0, "right"), (45, "behind right"), (90, "behind"), (180, "left"), (-90, "ahead"), (-45, "ahead right")],
)
def test_sides_are_the_robots_own(degrees: float, side: str) -> None:
    assert describe_scene(Scene(WALL_RIGHT, (robot(Pose(0, 0, math.radians(degrees))),))).endswith(
        f"m {side}"
    )


def test_the_nearest_target_counts_and_being_there_is_said() -> None:
    scene = Scene(bodies=(robot(Pose()),), targets=(Disc(3, 0, 0.2), Disc(-0.1, 0, 0.25)))
    assert describe_scene(scene) == "target 0.1 m at +180 deg, reached; no walls"


def test_touching_is_said_of_the_robot_that_touches() -> None:
    scene = Scene(
        bodies=(robot(Pose(), "one"), robot(Pose(2, 0, 0), "two"), SceneBody("box", Pose(1, 0, 0))),
        contacts=np.array([(2.05, 0.0)]),
    )
    assert describe_scene(scene).splitlines() == ["one: no walls", "two: no walls; touching"]


def test_nothing_to_report() -> None:
    assert describe_scene(Scene(maze())) == "no robot"


@given(st.floats(0.3, 8.0), st.floats(0.3, 4.9), st.floats(-3.2, 3.2))
def test_the_distance_to_the_walls_is_the_shortest_there_is(x: float, y: float, theta: float) -> None:
    """Against points sampled along the hull and the walls."""
    body = robot(Pose(x, y, theta))
    hull = np.concatenate([_along(np.vstack((part, part[:1])), 12) for part in body.polygons])
    if any(x0 <= px <= x1 and y0 <= py <= y1 for px, py in hull for x0, y0, x1, y1 in BOXES):
        return  # overlapping shapes have no distance
    distance, _ = nearest_wall(body, maze())
    walls = maze()
    apart = np.inf
    for start, end in zip(walls[:, :2], walls[:, 2:], strict=True):
        share = ((hull - start) @ (end - start)) / ((end - start) @ (end - start))
        foot = start + np.clip(share, 0, 1)[:, None] * (end - start)
        apart = min(apart, float(np.hypot(*(hull - foot).T).min()))
    assert distance <= apart + 1e-9
    assert distance >= apart - 0.01


def _along(points: np.ndarray, pieces: int) -> np.ndarray:
    shares = np.linspace(0, 1, pieces)[:, None]
    return np.concatenate([a + shares * (b - a) for a, b in itertools.pairwise(points)])


def test_a_round_robot_is_measured_from_its_rim() -> None:
    body = SceneBody("ball", Pose(0, 0, 0), discs=(Disc(0, 0, 0.2),), is_robot=True)
    assert nearest_wall(body, WALL_RIGHT)[0] == pytest.approx(0.285)


def test_plain_rows_fill_the_room_given_and_are_ascii() -> None:
    rows = scene_rows(Scene(maze(), (robot(Pose(0.5, 0.6, 1.57)),)), 60, 18)
    assert len(rows) == 18
    assert all(len(row) <= 60 and row.isascii() for row in rows)
    assert any("^" in row for row in rows)
