"""Many worlds for stable-baselines3: the same as one by one, and an algorithm takes them."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

from kit.learning.environment.env import TaskEnv
from kit.learning.tasks.catalogue import HALLWAY, TASKS, TURN, WHEELCHAIRS
from kit.learning.tasks.learning_task import LearningTask, UnknownTask

pytestmark = pytest.mark.skipif(
    find_spec("stable_baselines3") is None, reason="the extra learn is not installed"
)


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
def test_one_world_of_stable_baselines_is_the_environment(task: LearningTask) -> None:
    from stable_baselines3.common.vec_env import DummyVecEnv

    from kit.learning.environment.sb3_vec_env import make_vec_env

    task = replace(task, max_steps=25)
    plain, ours = DummyVecEnv([lambda: TaskEnv(task)]), make_vec_env(task, 1, seed=9)
    plain.seed(9)
    ours.seed(9)
    assert np.array_equal(plain.reset(), ours.reset())
    ours.action_space.seed(0)
    for _ in range(80):
        actions = np.array([ours.action_space.sample()])
        one, other = plain.step(actions), ours.step(actions)
        for a, b in zip(one[:3], other[:3], strict=True):
            assert np.array_equal(a, b)
        if one[2][0]:
            (expected,), (info,) = one[3], other[3]
            assert np.array_equal(info["terminal_observation"], expected["terminal_observation"])
            assert info["TimeLimit.truncated"] == expected["TimeLimit.truncated"]
            assert (info["case"], info["outcome"]) == (expected["case"], expected["outcome"])


def test_infos_tell_of_the_episode() -> None:
    from kit.learning.environment.sb3_vec_env import make_vec_env

    env = make_vec_env(replace(WHEELCHAIRS, max_steps=10), 5, seed=1)
    env.reset()
    rewards, told = np.zeros(5), 0
    for _ in range(25):
        _, earned, dones, infos = env.step(np.array([env.action_space.sample() for _ in range(5)]))
        rewards += earned
        assert [bool(info) for info in infos] == dones.tolist()
        for world in np.flatnonzero(dones).tolist():
            info = infos[world]
            assert info["episode"]["r"] == pytest.approx(rewards[world], abs=1e-5)
            assert sum(info["terms"].values()) == pytest.approx(rewards[world], abs=1e-4)
            assert info["is_success"] == (info["outcome"] == "reached")
            assert info["TimeLimit.truncated"] == (info["outcome"] == "timed out")
            assert 0.0 <= info["adjacency"] <= 1.0
            rewards[world] = 0.0
            told += 1
    assert told >= 5


@pytest.mark.long
@pytest.mark.parametrize("task", [TURN, HALLWAY, WHEELCHAIRS], ids=lambda task: task.name)
def test_ppo_takes_it(task: LearningTask) -> None:
    from stable_baselines3 import PPO

    from kit.learning.environment.sb3_vec_env import make_vec_env

    model = PPO(
        "MlpPolicy",
        make_vec_env(task, 8, seed=0),
        n_steps=16,
        batch_size=64,
        n_epochs=1,
        device="cpu",
        seed=0,
    )
    model.learn(256)
    assert model.num_timesteps == 256


def test_what_would_set_one_world_apart_is_refused() -> None:
    from stable_baselines3.common.monitor import Monitor

    from kit.learning.environment.sb3_vec_env import make_vec_env

    env = make_vec_env(TURN, 2)
    assert env.get_attr("n") == [2, 2]
    assert env.env_is_wrapped(object) == [False, False]
    assert env.env_is_wrapped(Monitor) == [True, True]
    with pytest.raises(AttributeError, match="only some"):
        env.set_attr("n", 3)
    with pytest.raises(AttributeError, match="only some"):
        env.env_method("reset")


def test_options_choose_cases_for_the_next_reset_alone() -> None:
    from stable_baselines3.common.vec_env import DummyVecEnv

    from kit.learning.environment.sb3_vec_env import make_vec_env

    ours, plain = make_vec_env(TURN, 3), DummyVecEnv([lambda: TaskEnv(TURN)])
    for env in (ours, plain):
        env.seed(4)
        env.set_options({"case": "turn_b_to_a"})
    assert np.array_equal(ours.reset()[0], plain.reset()[0])  # type: ignore[index]
    assert [info["case"] for info in ours.reset_infos] == ["turn_b_to_a"] * 3
    ours.seed(4)
    ours.set_options([{}, {"case": "turn_a_to_b"}, {"case": "turn_a_to_b"}])
    ours.reset()
    assert [info["case"] for info in ours.reset_infos] == ["turn_a_to_b"] * 3
    ours.reset()
    assert [info["case"] for info in ours.reset_infos] == ["turn_b_to_a", "turn_a_to_b", "turn_b_to_a"]
    ours.set_options({"cse": "turn_a_to_b"})
    with pytest.raises(ValueError, match='"cse"'):
        ours.reset()
    ours.set_options({"case": "turn_c"})
    with pytest.raises(UnknownTask, match="turn_c"):
        ours.reset()


def test_every_world_has_a_picture_where_asked() -> None:
    from stable_baselines3.common.vec_env import VecFrameStack

    from kit.learning.environment.sb3_vec_env import make_vec_env

    env = make_vec_env(TURN, 3, render_mode="rgb_array")
    env.reset()
    pictures = [np.asarray(each) for each in env.get_images()]
    assert len({each.tobytes() for each in pictures}) == 3
    height, width, _ = pictures[0].shape
    tiled = VecFrameStack(env, 2).render()
    assert tiled is not None
    assert tiled.shape == (2 * height, 2 * width, 3)
    assert env.metadata["render_fps"] == TaskEnv(TURN).metadata["render_fps"]
    assert make_vec_env(TURN, 2).get_images() == [None, None]
    with pytest.raises(ValueError, match="film"):
        make_vec_env(TURN, 3, render_mode="film")


def test_half_of_every_case_is_seen_in_a_mirror() -> None:
    from kit.learning.environment.mirror import TaskMirror
    from kit.learning.environment.sb3_vec_env import HalfMirroredVecEnv, make_vec_env

    task = HALLWAY.on("left_door", "turn_left_90", "straight")
    plainly, mirrored = (
        make_vec_env(task, 12, 3, fixed_cases=True),
        HalfMirroredVecEnv(make_vec_env(task, 12, 3, fixed_cases=True)),
    )
    mirror, which = TaskMirror(task), np.array([3, 4, 5, 9, 10, 11])
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
