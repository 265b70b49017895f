"""The scene: its extent, and that of a body in the body's own frame."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.geometry import Pose
from kit.render.scene import Disc, Scene, SceneBody, SceneBounds, Trail
from tests.render.scenes import maze, robot


@pytest.mark.parametrize("theta", [0.0, 1.0, -2.5])
def test_a_robots_extent_does_not_depend_on_how_it_stands(theta: float) -> None:
    assert robot(Pose(3.0, -1.0, theta)).extent == pytest.approx(SceneBounds(-0.117, -0.085, 0.048, 0.085))


def test_round_bodies_reach_their_radius() -> None:
    body = SceneBody("ball", Pose(1.0, 1.0, math.pi / 2), discs=(Disc(1.0, 2.0, 0.5),))
    assert body.extent == pytest.approx(SceneBounds(0.0, -0.5, 1.5, 0.5))
    assert SceneBody("dot", Pose(1.0, 1.0, 0.3)).extent == SceneBounds(0, 0, 0, 0)


def test_the_walls_bound_a_scene_and_without_walls_what_is_in_it() -> None:
    assert Scene(maze(), (robot(Pose(99, 99, 0)),)).bounds == SceneBounds(0, 0, 8.25, 5.175)
    bounds = Scene(bodies=(robot(Pose(1, 1, 0)),), targets=(Disc(4, 1, 0.5),)).bounds
    assert bounds == pytest.approx(SceneBounds(0.883, 0.5, 4.5, 1.5))
    assert Scene(targets=(Disc(math.nan, 0, 1),)).bounds == Scene().bounds
    assert Scene().bounds.width > 0


def test_scenes_without_walls_share_the_same_none() -> None:
    assert Scene().walls is Scene().walls
    assert not Scene().walls.flags.writeable
    assert np.shape(Scene().arrows) == (0, 5)


def test_points_keep_their_distance() -> None:
    trail = Trail(spacing=0.1)
    for step in range(101):
        trail.add(0.01 * step, 0.0)
    gaps = np.diff(trail.points[:, 0])
    assert (gaps >= 0.1 - 1e-9).all()
    assert (gaps < 0.12).all()


def test_the_old_part_is_thinner_and_the_oldest_is_gone() -> None:
    trail = Trail(spacing=1.0, length=80)
    for step in range(200):
        trail.add(float(step), 0.0)
    age = 199 - trail.points[:, 0]
    assert age.max() < 80
    counts = [int(((age >= low) & (age < low + 20)).sum()) for low in (60, 40, 20, 0)]
    assert counts == [5, 10, 20, 20]


def test_a_point_never_comes_back_or_moves() -> None:
    trail = Trail(spacing=1.0, length=40)
    seen: set[float] = set()
    gone: set[float] = set()
    for step in range(300):
        trail.add(float(step), 0.0)
        now = set(trail.points[:, 0].tolist())
        assert not now & gone
        gone |= seen - now
        seen = now


def test_an_empty_trail_is_an_array_all_the_same() -> None:
    trail = Trail()
    assert trail.points.shape == (0, 2)
    trail.add(1.0, 2.0)
    assert trail.points.tolist() == [[1.0, 2.0]]
    trail.clear()
    assert trail.points.shape == (0, 2)
