"""Distances from walls: many poses at once are as each by itself, and one side leaves the other out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.geometry import Pose
from kit.render.clearance import nearest_wall, nearest_wall_distances, side_wall_distances
from kit.render.scene import Disc, SceneBody


@pytest.mark.parametrize("discs", [(), (Disc(0.3, 0.1, 0.05),)], ids=["polygons", "polygons-and-a-disc"])
def test_distances_of_many_poses_are_those_of_each(discs: tuple[Disc, ...]) -> None:
    chance = np.random.default_rng(1)
    walls = chance.uniform(-3, 3, (60, 4))
    poses = [Pose(*chance.uniform(-4, 4, 3)) for _ in range(70)]
    corners = [
        np.array([(0.2, 0.1), (-0.2, 0.1), (-0.2, -0.1)]),
        np.array([(0.3, 0.0), (0.2, 0.1), (0.2, -0.1)]),
    ]
    robots = [
        SceneBody(
            "robot",
            pose,
            tuple(np.array([pose.transform_point(*point) for point in polygon]) for polygon in corners),
            tuple(Disc(*pose.transform_point(disc.x, disc.y), disc.radius) for disc in discs),
            is_robot=True,
        )
        for pose in poses
    ]
    assert nearest_wall_distances(robots, walls).tolist() == [nearest_wall(each, walls)[0] for each in robots]


@pytest.mark.parametrize("heading", [0.0, 0.4, 2.0, -3.0])
def test_distances_to_one_side_leave_the_other_out(heading: float) -> None:
    """Two walls along the way, 1 m to the left and 2 m to the right of it, and one across behind it that counts on both."""
    lanes = np.array([(-5.0, 1.0, 5.0, 1.0), (-5.0, -2.0, 5.0, -2.0), (-3.0, -1.0, -3.0, 0.5)])
    cos, sin = math.cos(heading), math.sin(heading)
    turn = np.array([[cos, sin], [-sin, cos]])
    walls = (lanes.reshape(-1, 2) @ turn).reshape(-1, 4)
    poses = np.array([(0.0, 0.0, heading), (0.0, 0.0, heading + math.pi)])
    hull = SceneBody("robot", Pose(), (np.array([(0.2, 0.1), (-0.2, 0.1), (-0.2, -0.1), (0.2, -0.1)]),))
    left = side_wall_distances(hull, poses, walls, left=True, within=5.0)
    right = side_wall_distances(hull, poses, walls, left=False, within=5.0)
    assert left.tolist() == pytest.approx([0.9, 1.9])
    assert right.tolist() == pytest.approx([1.9, 0.9])
    assert np.isinf(side_wall_distances(hull, poses, walls, left=True, within=1.0)).tolist() == [False, True]
    only = side_wall_distances(hull, poses[:1], walls[2:], left=True, within=5.0)
    assert only.tolist() == pytest.approx([2.8])
