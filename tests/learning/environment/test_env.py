"""The tasks as Gymnasium environments: the checkers, episodes, pictures, task cards."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import kit.learning
from kit.learning.environment.batch import BatchEnv, RewardError
from kit.learning.environment.env import (
    HallwayEnv,
    TaskEnv,
    TurnEnv,
    WheelchairsEnv,
    build_batch_scene,
)
from kit.learning.tasks.catalogue import HALLWAY, TASKS, TURN, WHEELCHAIRS
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.rewards import ALGORITHM_3
from tests.learning import worlds

REGISTERED = sorted(name for name in gymnasium.registry if name.startswith("RobotKit/"))
CLASSES = {"Turn": TurnEnv, "Hallway": HallwayEnv, "Wheelchairs": WheelchairsEnv}
every_task = pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
needs_learner = pytest.mark.skipif(
    find_spec("stable_baselines3") is None, reason="the extra learn is not installed"
)


def make(name: str, **options: object) -> TaskEnv:
    env = gymnasium.make(f"RobotKit/{name}-v0", **options).unwrapped
    assert isinstance(env, TaskEnv)
    return env


def test_three_environments_are_registered() -> None:
    assert kit.learning.__doc__
    assert REGISTERED == ["RobotKit/Hallway-v0", "RobotKit/Turn-v0", "RobotKit/Wheelchairs-v0"]
    assert {name: type(make(name)) for name in CLASSES} == CLASSES


@every_task
def test_gymnasiums_checker_passes(task: LearningTask) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(TaskEnv(task, render_mode="rgb_array"), skip_render_check=True)


@pytest.mark.long_cases("turn", "turn-seed")
@every_task
@needs_learner
def test_the_checker_of_stable_baselines_passes(task: LearningTask) -> None:
    from stable_baselines3.common.env_checker import check_env as check

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(TaskEnv(task))


@pytest.mark.parametrize("name", CLASSES)
def test_a_task_card_tells_the_sizes_that_the_spaces_have(name: str) -> None:
    env = make(name)
    lines = type(env).__doc__ or ""
    card = " ".join(lines.split())
    assert f"RobotKit/{name}-v0" in card
    assert f"Box {env.observation_space.shape}" in card
    kind = type(env.action_space).__name__
    numbers = getattr(env.action_space, "n", None) or ", ".join(map(str, env.action_space.nvec))
    assert f"{kind} ({numbers})" in card
    assert f"after {env.task.max_steps} steps" in card
    assert f"{env.task.target_radius:g} m of the target" in card
    assert f"{env.task.step_time:g} s" in card
    for part in ("Observation:", "Actions:", "Reward:", "Start:", "End:"):
        assert re.search(rf"^    {part} ", lines, re.MULTILINE), part


@pytest.mark.parametrize("name", CLASSES)
def test_a_seed_repeats_an_episode(name: str) -> None:
    runs = []
    for _ in range(2):
        env = make(name)
        seen, info = env.reset(seed=4)
        env.action_space.seed(4)
        run = [seen.tobytes(), info["case"]]
        for _ in range(20):
            seen, reward, *_ = env.step(env.action_space.sample())
            run += [seen.tobytes(), reward]
        runs.append(run)
    assert runs[0] == runs[1]


def test_without_a_seed_chance_decides() -> None:
    assert len({make("Hallway").reset()[0].tobytes() for _ in range(3)}) == 3


def test_start_and_target_change_places() -> None:
    env = make("Turn")
    cases = [env.reset(seed=0)[1]["case"]] + [env.reset()[1]["case"] for _ in range(3)]
    assert cases == ["turn_a_to_b", "turn_b_to_a"] * 2
    ends = False
    while not ends:
        *_, ends, late, info = env.step(0)
        ends = ends or late
    assert info["outcome"] in ("reached", "collided", "timed out")
    assert env.reset()[1]["case"] == "turn_a_to_b"  # also after an episode that was driven to its end


def test_a_case_can_be_chosen() -> None:
    env = make("Hallway")
    assert env.reset(seed=1, options={"case": "two_doors"})[1]["case"] == "two_doors"
    with pytest.raises(UnknownTask, match="two_doors"):
        env.reset(options={"case": "two_dors"})


def test_a_variant_of_a_task() -> None:
    env = make("Hallway", task=HALLWAY.on("doors"), reward=ALGORITHM_3)
    assert env.reset(seed=1)[1]["case"] == "left_door"
    *_, info = env.step(np.int64(1))
    assert list(info["terms"]) == [weight.term for weight in ALGORITHM_3.weights]


@pytest.mark.parametrize(("returned", "said"), [(None, "return"), (1.0, r"shape \(1,\)")])
def test_a_reward_that_is_no_array_is_refused(returned: object, said: str) -> None:
    env = make("Turn", reward=lambda step: returned)
    env.reset(seed=1)
    with pytest.raises(RewardError, match=said):
        env.step(0)


def test_the_terms_add_up_to_the_reward() -> None:
    env = make("Wheelchairs")
    env.reset(seed=3)
    for _ in range(5):
        _, reward, _, _, info = env.step(env.action_space.sample())
        assert sum(info["terms"].values()) == pytest.approx(reward, abs=1e-6)
        assert isinstance(info["adjacent"], bool)


@pytest.mark.parametrize("terminal", [False, True])
def test_running_out_of_time(terminal: bool) -> None:
    env = TaskEnv(replace(WHEELCHAIRS, max_steps=2, timeout_terminal=terminal))
    env.reset(seed=0)
    env.step(np.zeros(2, dtype=np.int64))
    _, _, ended, truncated, info = env.step(np.zeros(2, dtype=np.int64))
    assert (ended, truncated) == (terminal, not terminal)
    assert info["outcome"] == "timed out"


def test_a_step_before_the_first_reset_is_refused() -> None:
    with pytest.raises(gymnasium.error.ResetNeeded):
        TaskEnv(TURN).step(0)


def test_an_unknown_render_mode_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(ValueError, match="rgb_array"):
        TaskEnv(TURN, render_mode="rgb_aray")


@pytest.mark.parametrize("name", CLASSES)
def test_a_picture(name: str) -> None:
    env = make(name, render_mode="rgb_array")
    env.reset(seed=1)
    first = env.render()
    assert first.shape == (480, 480, 3)
    assert first.dtype == np.uint8
    for _ in range(3):
        env.step(np.full_like(env.action_space.sample(), 1 if name != "Turn" else 0))
    assert (env.render() != first).any()


@pytest.mark.parametrize("name", CLASSES)
def test_characters_and_words(name: str) -> None:
    env = make(name, render_mode="ansi")
    env.reset(seed=1)
    text = env.render()
    assert "#" in text
    assert text.count("target") == env.task.robots
    assert text.isascii()


def test_a_task_of_ones_own_by_its_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(
        "maps: [turn]\nactions: {linear: [0, 0.5], angular: [-1, 1]}\nobservation: {sectors: 4, speeds: true}\n"
        "reward: {terms: {progress: 1}}\nstep: {limit: 3}\n"
    )
    env = make("Turn", task=file, case="turn_b_to_a")
    assert (env.observation_space.shape, env.action_space.shape) == ((6,), (2,))
    for _ in range(2):
        assert env.reset(seed=1)[1]["case"] == "turn_b_to_a"
    *_, late, info = [env.step(env.action_space.sample()) for _ in range(3)][-1]
    assert late
    assert list(info["terms"]) == ["progress"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(TaskEnv(str(file)), skip_render_check=True)
    assert make("Turn", task="wall-follower").task.name == "wall-follower"
    with pytest.raises(UnknownTask, match="no file"):
        make("Turn", task=tmp_path / "other.yaml")


@pytest.mark.parametrize("name", worlds.TASKS)
def test_a_scene_shows_robots_target_and_walls(name: str) -> None:
    task = worlds.TASKS[name]
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
