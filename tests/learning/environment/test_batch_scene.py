"""A world of a batch as a scene."""

from __future__ import annotations

import numpy as np
import pytest

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_scene import build_batch_scene
from tests.learning.worlds import TASKS


@pytest.mark.parametrize("name", TASKS)
def test_a_scene_shows_robots_target_and_walls(name: str) -> None:
    task = TASKS[name]
    batch = BatchEnv(task, 3, seed=1)
    batch.reset()
    trail = np.array([[0.0, 0.0], [0.1, 0.1]])
    scene = build_batch_scene(batch, 2, (trail,))
    assert [body.pose[:2] for body in scene.robots] == [tuple(p[:2]) for p in batch.state.pose[2].tolist()]
    assert [len(body.polygons) for body in scene.bodies] == [3] * task.robots
    ((x, y, radius),) = scene.targets
    assert [x, y] == batch.state.target[2].tolist()
    assert radius == task.target_radius
    assert scene.trails == (trail,)
    assert (
        scene.walls is build_batch_scene(batch, 2).walls
    )  # its identity is the key of the picture's static layer
    for body in scene.bodies:
        corners = np.concatenate(body.polygons) - body.pose[:2]
        assert np.hypot(*corners.T).max() == pytest.approx(0.129, abs=5e-4)
