"""One world of a batch, to be drawn."""

from __future__ import annotations

import numpy as np

from kit.geometry import Pose
from kit.learning.environment.batch import BatchEnv
from kit.render.scene import Disc, FloatArray, Scene, SceneBody

ROBOT_NAMES = ("left", "right")


def build_batch_scene(batch: BatchEnv, world: int, trails: tuple[FloatArray, ...] = ()) -> Scene:
    """Builds the drawing of one world now. ``trails``: (k, 2) per robot, its path so far [m]."""
    state = batch.state
    card, batch_map = batch.map_of_case(int(state.case[world]))
    poses = [Pose(*pose) for pose in state.pose[world].tolist()]
    names = (card.robot,) if len(poses) == 1 else ROBOT_NAMES
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
    target = Disc(x, y, batch.task.target_radius)
    return Scene(walls=batch_map.walls, bodies=bodies, targets=(target,), trails=trails)
