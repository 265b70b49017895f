"""The scene: its extent, and that of a body in the body's own frame."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.geometry import Pose
from kit.render.scene import Disc, Scene, SceneBody, SceneBounds
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
