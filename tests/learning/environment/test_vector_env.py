"""Many worlds for Gymnasium: resets in the same step, and what is told of the episode that ended."""

from __future__ import annotations

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.tasks import TURN
from kit.learning.environment.vector_env import BatchVectorEnv

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


def test_the_worlds_can_be_of_one_case_and_of_a_task_by_name() -> None:
    env = gymnasium.make_vec("RobotKit/Turn-v0", num_envs=2, task="smooth-turn", case="turn_b_to_a")
    assert isinstance(env, BatchVectorEnv)
    assert [case.name for case in env.batch.cases] == ["turn_b_to_a"]
    assert env.single_action_space.shape == (2,)


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
