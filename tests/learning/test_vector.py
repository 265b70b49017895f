"""Many worlds for Gymnasium and for stable-baselines3: resets in the same step, infos, the same as one by one."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from kit.learning.batch import BatchEnv
from kit.learning.env import TaskEnv
from kit.learning.tasks import HALLWAY, TASKS, TURN, WHEELCHAIRS, Task
from kit.learning.vector import BatchVectorEnv

needs_learner = pytest.mark.skipif(
    find_spec("stable_baselines3") is None, reason="the extra learn is not installed"
)
QUICK = replace(TURN, max_steps=12)


@pytest.mark.parametrize("name", ["Turn", "Hallway", "Wheelchairs"])
def test_gymnasium_makes_it(name: str) -> None:
    env = gymnasium.make_vec(f"RobotKit/{name}-v0", num_envs=3)
    assert isinstance(env, BatchVectorEnv)
    observations, _ = env.reset(seed=1)
    assert env.observation_space.contains(observations)
    step = env.step(env.action_space.sample())
    assert env.observation_space.contains(step[0])
    assert [part.shape for part in step[1:4]] == [(3,)] * 3


def test_gymnasiums_worlds_reset_in_the_same_step() -> None:
    env, batch = BatchVectorEnv(4, QUICK, seed=2), BatchEnv(QUICK, 4, seed=2)
    assert env.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    env.reset(seed=2)
    batch.reset(2)
    chance, ended = np.random.default_rng(0), 0
    for _ in range(40):
        actions = chance.integers(3, size=4)
        observations, rewards, terminated, truncated, info = env.step(actions)
        step = batch.step(actions)
        assert np.array_equal(observations, step.observations)
        assert np.array_equal(rewards, step.rewards)
        over = terminated | truncated
        assert np.array_equal(over, step.ended)
        assert ("final_obs" in info) == over.any()
        for world in np.flatnonzero(over).tolist():
            assert np.array_equal(info["final_obs"][world], step.final_observations[world])
            assert info["final_info"]["episode"]["l"][world] == step.transition.step[world]
            ended += 1
    assert ended


def test_gymnasium_wants_one_seed() -> None:
    with pytest.raises(ValueError, match="one seed"):
        BatchVectorEnv(2, QUICK).reset(seed=[1, 2])


@needs_learner
@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
def test_one_world_of_stable_baselines_is_the_environment(task: Task) -> None:
    from stable_baselines3.common.vec_env import DummyVecEnv

    from kit.learning.vecenv import make_vec

    task = replace(task, max_steps=25)
    plain, ours = DummyVecEnv([lambda: TaskEnv(task)]), make_vec(task, 1, seed=9)
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


@needs_learner
def test_infos_tell_of_the_episode() -> None:
    from kit.learning.vecenv import make_vec

    env = make_vec(replace(WHEELCHAIRS, max_steps=10), 5, seed=1)
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


@needs_learner
@pytest.mark.parametrize("task", [TURN, HALLWAY, WHEELCHAIRS], ids=lambda task: task.name)
def test_ppo_takes_it(task: Task) -> None:
    from stable_baselines3 import PPO

    from kit.learning.vecenv import make_vec

    model = PPO(
        "MlpPolicy", make_vec(task, 8, seed=0), n_steps=16, batch_size=64, n_epochs=1, device="cpu", seed=0
    )
    model.learn(256)
    assert model.num_timesteps == 256


@needs_learner
def test_what_would_set_one_world_apart_is_refused() -> None:
    from kit.learning.vecenv import make_vec

    env = make_vec(TURN, 2)
    assert env.get_attr("n") == [2, 2]
    assert env.env_is_wrapped(object) == [False, False]
    with pytest.raises(AttributeError, match="one"):
        env.set_attr("n", 3)
    with pytest.raises(AttributeError, match="one"):
        env.env_method("reset")
