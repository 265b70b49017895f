"""In a mirror, the mirrored moves lead to the mirrored views."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from kit.learning.actions import Actions, Move
from kit.learning.batch import BatchEnv
from kit.learning.mirror import HalfMirrored, Mirror
from kit.learning.observations import NINE
from kit.learning.tasks import HALLWAY, TURN, WHEELCHAIRS, Start, Task
from kit.learning.vecenv import make_vec

TELLING = replace(HALLWAY.observation, target=True, arrived=True)


def plain(task: Task, case: str) -> Task:
    """The task on one case, without chance."""
    return replace(task.on(case), start=Start(shifted=False, gap=task.start.gap), lidar_noise=0.0)


@pytest.mark.parametrize(
    ("task", "case", "other"),
    [
        (HALLWAY, "curve_left_90", "curve_right_90"),
        (HALLWAY, "left_door", "right_door"),
        (replace(HALLWAY, observation=TELLING), "curve_left_180", "curve_right_180"),
        (WHEELCHAIRS, "pair_curve_left_180", "pair_curve_right_180"),
        (
            replace(WHEELCHAIRS, actions=replace(WHEELCHAIRS.actions, one_number=True)),
            *("pair_curve_right_180", "pair_curve_left_180"),
        ),
    ],
)
def test_the_mirror_image_of_a_drive(task: Task, case: str, other: str) -> None:
    mirror, chance = Mirror(task), np.random.default_rng(2)
    here, there = (BatchEnv(plain(task, name), 1) for name in (case, other))
    seen, looked_at = here.reset(), there.reset()
    space = here.action_space
    space.seed(4)
    for _ in range(60):
        assert mirror.observations(seen) == pytest.approx(looked_at, abs=5e-4)
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
        mirror, batch = Mirror(task), BatchEnv(task, 20, seed=1)
        seen = batch.reset()
        assert mirror.observations(mirror.observations(seen)).tobytes() == seen.tobytes()
        actions = np.stack([batch.action_space.sample() for _ in range(20)])
        assert (mirror.actions(mirror.actions(actions)) == actions).all()


def test_what_has_no_mirror_image_is_refused() -> None:
    with pytest.raises(ValueError, match="both sides"):
        Mirror(replace(TURN, observation=NINE))
    with pytest.raises(ValueError, match="two sides"):
        Mirror(replace(HALLWAY, actions=Actions((Move.FORWARD, Move.LEFT), 0.3, 1.0)))


def test_half_of_every_case_is_seen_in_a_mirror() -> None:
    task = HALLWAY.on("left_door", "turn_left_90", "straight")
    plainly, mirrored = make_vec(task, 12, 3, stay=True), HalfMirrored(make_vec(task, 12, 3, stay=True))
    mirror, which = Mirror(task), np.array([3, 4, 5, 9, 10, 11])
    others = np.setdiff1d(np.arange(12), which)
    seen: Any = (plainly.reset(), mirrored.reset())
    chance = np.random.default_rng(0)
    over = 0
    for _ in range(120):
        assert (seen[1][which] == mirror.observations(seen[0][which])).all()
        assert (seen[1][others] == seen[0][others]).all()
        actions = chance.integers(0, 7, 12)
        shown = actions.copy()
        shown[which] = mirror.actions(actions[which])
        (first, rewards, dones, infos), (second, rewards2, dones2, infos2) = (
            plainly.step(actions),
            mirrored.step(shown),
        )
        assert (rewards == rewards2).all()
        assert (dones == dones2).all()
        for number in np.flatnonzero(dones):
            last, last2 = infos[number]["terminal_observation"], infos2[number]["terminal_observation"]
            assert (last2 == (mirror.observations(last) if number in which else last)).all()
            over += 1
        seen = (first, second)
    assert over
