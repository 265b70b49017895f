"""One world of a batch, to be drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kit.geometry import Pose
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_map import BatchMap
from kit.render.scene import Disc, FloatArray, Scene, SceneBody
from kit.world.records import Circle, Polygon

ROUND_CORNERS = 16
"""A circle is drawn as a polygon of so many corners."""


def build_batch_scene(batch: BatchEnv, world: int, trails: tuple[FloatArray, ...] = ()) -> Scene:
    """Builds the drawing of one world now. ``trails``: (k, 2) per robot, its path so far [m]."""
    state = batch.state
    _, batch_map = batch.map_of_case(int(state.case[world]))
    poses = [Pose(*pose) for pose in state.pose[world].tolist()]
    names = batch_map.robot_names
    bodies = tuple(
        SceneBody(
            name,
            pose,
            tuple(
                np.array([pose.transform_point(*corner) for corner in corners])
                for corners in batch_map.robot.hull
            ),
            is_robot=True,
        )
        for name, pose in zip(names, poses, strict=True)
    )
    x, y = state.target[world].tolist()
    targets = (Disc(x, y, batch.task.target_radius),) if batch.shows_target else ()
    things = tuple(_obstacle_bodies(batch_map, batch.obstacle_poses(world)))
    return Scene(walls=batch_map.walls, bodies=bodies + things, targets=targets, trails=trails)


def lidar_places(batch: BatchEnv, world: int) -> FloatArray:
    """(robots, 3): where the lidars of one world are now [m], and the headings of their robots [rad]."""
    state = batch.state
    _, batch_map = batch.map_of_case(int(state.case[world]))
    lidar = batch_map.robot.lidar
    poses = [Pose(*pose) for pose in state.pose[world].tolist()]
    return np.array([(*pose.transform_point(lidar.x, lidar.y), pose.theta) for pose in poses])


def _obstacle_bodies(batch_map: BatchMap, poses: FloatArray) -> Iterator[SceneBody]:
    for obstacle, (x, y, theta) in zip(batch_map.obstacles, poses.tolist(), strict=False):
        pose = Pose(x, y, theta)
        outlines = tuple(
            np.array([pose.transform_point(*corner) for corner in _outline(part.shape)])
            for part in obstacle.parts
        )
        if outlines:
            yield SceneBody(obstacle.name, pose, outlines, is_robot=False)


def _outline(shape: Circle | Polygon) -> list[tuple[float, float]]:
    if isinstance(shape, Polygon):
        return list(shape.points)
    (x, y), angles = shape.center, np.linspace(0.0, 2.0 * math.pi, ROUND_CORNERS, endpoint=False)
    return [(x + shape.radius * math.cos(angle), y + shape.radius * math.sin(angle)) for angle in angles]
