"""In a mirror, the mirrored moves lead to the mirrored views."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.mirror import TaskMirror
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.tasks.actions import DiscreteActions, Move
from kit.learning.tasks.catalogue import HALLWAY, TURN, WHEELCHAIRS
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from tests.learning.worlds import NINE_NUMBERS

TELLING = replace(HALLWAY.observation, target=True, arrived=True)


def plain(task: LearningTask, case: str) -> LearningTask:
    """The task on one case, without chance."""
    return replace(task.on(case), start=StartVariation(shifted=False, gap=task.start.gap), lidar_noise=0.0)


@pytest.mark.parametrize(
    ("task", "case", "other"),
    [
        (HALLWAY, "left_door", "right_door"),
        (replace(HALLWAY, observation=TELLING), "curve_left_180", "curve_right_180"),
        (WHEELCHAIRS, "pair_curve_left_180", "pair_curve_right_180"),
        (
            replace(WHEELCHAIRS, actions=replace(WHEELCHAIRS.actions, one_number=True)),
            *("pair_curve_right_180", "pair_curve_left_180"),
        ),
    ],
)
def test_the_mirror_image_of_a_drive(task: LearningTask, case: str, other: str) -> None:
    mirror, chance = TaskMirror(task), np.random.default_rng(2)
    here, there = (BatchEnv(plain(task, name), 1) for name in (case, other))
    seen, looked_at = here.reset(), there.reset()
    space = here.action_space
    space.seed(4)
    millimetre = 0.001 * task.observation.scale
    for _ in range(60):
        assert mirror.observations(seen) == pytest.approx(looked_at, abs=millimetre)
        action: Any = np.array([space.sample()])
        if chance.random() < 0.6 and task.robots == 1:
            action[:] = list(Move).index(Move.FORWARD)
        one, two = here.step(action), there.step(mirror.actions(action))
        assert one.ended.tolist() == two.ended.tolist()
        assert one.rewards == pytest.approx(two.rewards, abs=1e-3)
        if one.ended.any():
            break
        seen, looked_at = one.observations, two.observations


def test_twice_in_a_mirror_is_as_before() -> None:
    for task in (HALLWAY, WHEELCHAIRS, replace(HALLWAY, observation=TELLING)):
        mirror, batch = TaskMirror(task), BatchEnv(task, 20, seed=1)
        seen = batch.reset()
        assert mirror.observations(mirror.observations(seen)).tobytes() == seen.tobytes()
        actions = np.stack([batch.action_space.sample() for _ in range(20)])
        assert (mirror.actions(mirror.actions(actions)) == actions).all()


def test_what_has_no_mirror_image_is_refused() -> None:
    with pytest.raises(UnsupportedWorld, match="not symmetric"):
        TaskMirror(replace(TURN, observation=NINE_NUMBERS))
    with pytest.raises(UnsupportedWorld, match="two sides"):
        TaskMirror(replace(HALLWAY, actions=DiscreteActions(("forward", "left"), ((0.3, 0.0), (0.0, 1.0)))))
