"""Robots as agents of their own: PettingZoo's test, and the same world as Gymnasium's environment."""

from __future__ import annotations

import sys
import warnings
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from kit.learning.environment.env import TaskEnv
from kit.learning.tasks.actions import ContinuousActions
from kit.learning.tasks.catalogue import WHEELCHAIRS, WHEELCHAIRS_SEED
from kit.learning.tasks.learning_task import LearningTask

pettingzoo_test = pytest.importorskip("pettingzoo.test", reason="the extra pettingzoo is not installed")

TASKS = {
    "one choice each": WHEELCHAIRS,
    "one number": WHEELCHAIRS_SEED,
    "continuous": replace(WHEELCHAIRS, actions=ContinuousActions((0.0, 0.3), (-1.0, 1.0))),
    "frames": replace(WHEELCHAIRS, observation=replace(WHEELCHAIRS.observation, frames=3)),
}


NO_OPTION = r"reset\(\) has no option"
"""PettingZoo's own test gives an option that is none."""


def make(task: LearningTask | str):  # type: ignore[no-untyped-def]  # the module is imported where PettingZoo is
    return import_module("kit.learning.environment.parallel_env").RobotsParallelEnv(task)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
def test_pettingzoos_own_test_passes(task: LearningTask, capsys: pytest.CaptureFixture[str]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", NO_OPTION)
        pettingzoo_test.parallel_api_test(make(task), num_cycles=300)
    assert "Passed" in capsys.readouterr().out


def test_an_option_that_is_none_is_warned_of() -> None:
    env = make("smooth-turn")
    with pytest.warns(UserWarning, match='"case"'):
        env.reset(seed=1, options={"cse": "turn_a_to_b"})


@pytest.mark.parametrize(
    ("actions", "said"),
    [({"left": 0}, "none of right"), ({"left": 0, "right": 0, "rihgt": 0}, 'did you mean "right"')],
)
def test_every_agent_and_nobody_else_has_an_action(actions: dict[str, int], said: str) -> None:
    env = make("wheelchairs")
    env.reset(seed=1)
    with pytest.raises(KeyError, match=said):
        env.step(actions)


@pytest.mark.filterwarnings(f"ignore:{NO_OPTION}")
def test_one_robot_is_an_environment_too() -> None:
    env = make("smooth-turn")
    assert env.possible_agents == ["serp"]
    pettingzoo_test.parallel_api_test(env, num_cycles=50)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
def test_all_robots_together_are_what_one_agent_drives(task: LearningTask) -> None:
    env, together = make(task), TaskEnv(task)
    seen, infos = env.reset(seed=5)
    whole, info = together.reset(seed=5)
    assert env.agents == ["left", "right"]
    assert infos["left"]["case"] == info["case"]
    for number in range(30):
        assert env.state().tolist() == whole.tolist()
        frames = whole.reshape(task.observation.frames, 2, -1)
        assert seen["right"].tolist() == frames[:, 1].ravel().tolist()
        assert all(env.observation_space(agent).contains(seen[agent]) for agent in seen)
        actions = {agent: env.action_space(agent).sample() for agent in env.agents}
        joint = (
            np.concatenate([actions["left"], actions["right"]])
            if isinstance(task.actions, ContinuousActions)
            else task.actions.encode(np.array([[actions["left"], actions["right"]]]), 2)[0]
        )
        seen, rewards, ends, late, _ = env.step(actions)
        whole, reward, terminated, truncated, _ = together.step(joint)
        assert rewards == {"left": reward, "right": reward}
        assert (ends["left"], late["right"]) == (terminated, truncated)
        if terminated or truncated:
            assert env.agents == []
            assert number > 0
            break


def test_without_pettingzoo_it_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pettingzoo", None)
    monkeypatch.delitem(sys.modules, "kit.learning.environment.parallel_env", raising=False)
    with pytest.raises(ImportError, match=r"pip install .*pettingzoo"):
        import_module("kit.learning.environment.parallel_env")
