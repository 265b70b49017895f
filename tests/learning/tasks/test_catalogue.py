"""Tasks: their figures are those of the dissertation, and parts of them can be chosen by name."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.geometry import Pose
from kit.learning.environment.batch import BatchEnv
from kit.learning.maps.ray_directions import ray_direction
from kit.learning.tasks.actions import Move
from kit.learning.tasks.catalogue import (
    HALLWAY,
    HALLWAY_SEED,
    TASKS,
    TURN_SEED,
    WHEELCHAIRS_SEED,
    WHEELCHAIRS_SEED_49,
    find_task,
    task_names,
)
from kit.learning.tasks.disturbances import Disturbances
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.reward_terms import turn_completed_reward
from kit.learning.tasks.rewards import ALGORITHM_1, ALGORITHM_2, ALGORITHM_3, REWARD_SCALE, REWARDS
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.sim.simulation import Simulation, load_world
from kit.world.problems import WorldError
from tests.cases import every_case


def sizes(task: LearningTask) -> tuple[object, ...]:
    spaces = task.observation.space(task.robots), task.actions.space(task.robots)
    return spaces[0].shape, str(spaces[1]), task.max_steps, task.step_time, task.target_radius


def test_the_dissertations_sizes() -> None:
    assert sizes(TURN_SEED) == ((9,), "Discrete(3)", 200, 0.1, 0.2)
    assert sizes(HALLWAY_SEED) == ((17,), "Discrete(7)", 200, 0.2, 0.25)
    assert sizes(WHEELCHAIRS_SEED_49) == ((38,), "Discrete(49)", 300, 0.2, 0.25)
    assert sizes(WHEELCHAIRS_SEED) == ((38,), "Discrete(16)", 300, 0.2, 0.4)
    assert WHEELCHAIRS_SEED.start.gap == 0.4
    assert all(task.timeout_terminal == ("-seed" in task.name) for task in TASKS)
    assert {name for name in task_names() if "-seed" in name} <= {task.name for task in TASKS}


def test_the_dissertations_speeds() -> None:
    turn = dict(zip(TURN_SEED.actions.moves, TURN_SEED.actions.twists.tolist(), strict=True))
    assert turn[Move.FORWARD] == [0.5, 0.0]
    assert turn[Move.LEFT] == [0.0, pytest.approx(math.pi / 2)]
    hall = dict(zip(HALLWAY.actions.moves, HALLWAY.actions.twists.tolist(), strict=True))
    assert hall[Move.STOP] == [0.0, 0.0]
    assert hall[Move.BACK] == [-0.3, 0.0]
    assert hall[Move.FORWARD_RIGHT] == [0.3, pytest.approx(-math.pi / 3)]


def test_the_dissertations_rewards() -> None:
    assert (TURN_SEED.reward, HALLWAY_SEED.reward) == (ALGORITHM_3, ALGORITHM_1)
    assert WHEELCHAIRS_SEED_49.reward == ALGORITHM_2
    assert WHEELCHAIRS_SEED.reward.weights[:-1] == ALGORITHM_2.weights


def test_as_it_was_run_the_laser_sees_the_wheels_and_nothing_else_to_the_sides() -> None:
    text, run = (BatchEnv(find_task(name), 30, seed=4) for name in ("hallway-seed", "hallway-seed-as-run"))
    told = [batch.step(np.ones(30, dtype=np.int64)).transition.ranges[:, 0] for batch in (text, run)]
    hidden = [ray for ray in range(91) if 59.7 <= abs(math.degrees(ray_direction(ray))) <= 120.3]
    rest = [ray for ray in range(91) if ray not in hidden]
    assert np.median(told[1][:, hidden]) == pytest.approx(0.065, abs=0.006)
    assert told[1][:, hidden].max() < 0.15  # the lidar's noise
    assert (told[0][:, rest] == told[1][:, rest]).all()


def test_as_it_was_run_a_whole_turn_is_charged_in_the_step_that_completes_it() -> None:
    batch = BatchEnv(find_task("hallway-seed-as-run").on("straight"), 1, seed=0)
    left = np.array([batch.task.actions.names.index("left")])  # type: ignore[union-attr]  # they are a table
    charged = [float(turn_completed_reward(batch.step(left).transition)[0]) for _ in range(62)]
    assert sorted(charged)[-3:] == [0.0, 1.0, 2.0]
    assert abs(charged.index(2.0) - charged.index(1.0)) == 30  # steps of 12 degrees


PAIRS_AS_RUN = ("wheelchairs-seed-49-as-run", "wheelchairs-seed-49-wide-as-run", "wheelchairs-seed-as-run")


@pytest.mark.parametrize("name", PAIRS_AS_RUN)
def test_as_they_were_run_wheels_touch_nothing_and_the_other_robot_sees_them(name: str) -> None:
    task = replace(find_task(name).on("pair_straight"), lidar_noise=0.0)
    batch = BatchEnv(task, 1, seed=0)
    robot = batch.map_of_case(0)[1].robot
    assert [np.abs(np.array(hull)[:, 1]).max() for hull in robot.hull] == [0.055]
    assert {np.abs(np.array(part)[:, 1]).max() for part in robot.untouched} == {0.085}
    batch.reset()
    stop = np.array([task.actions.encode(np.zeros((1, 2), dtype=np.int64), 2)[0]])  # type: ignore[union-attr]  # a table
    ranges = batch.step(stop).transition.ranges[0]
    gap = float(np.hypot(*(batch.state.pose[0, 0] - batch.state.pose[0, 1])[:2]))
    right_of_left, left_of_right = ranges[0, 22], ranges[1, 68]  # straight across, 2 degrees off
    for seen in (right_of_left, left_of_right):
        assert seen == pytest.approx(gap - 0.085, abs=0.003)
    card = task.map_cards[0]
    world = load_world(card.world_file, root=card.root)
    simulation = Simulation(world, step_size=0.01, has_subscribers=lambda topic: True)
    for model, pose in zip(("left", "right"), batch.state.pose[0].tolist(), strict=True):
        simulation.move_model(model, Pose(*pose))
    for _ in range(30):
        simulation.step()
    scans = {view.model: np.minimum(view.ranges, 2.0) for view in simulation.latest_scans()}
    for number, model in enumerate(("left", "right")):
        # A ray that passes an edge by a hair may meet it in one of the engines only.
        assert (np.abs(scans[model] - ranges[number]) > 0.08).sum() <= 2


@pytest.mark.long
@pytest.mark.parametrize("name", PAIRS_AS_RUN)
def test_as_they_were_run_nothing_can_happen_in_the_first_three_steps(name: str) -> None:
    """The code ignored collisions and arrivals there, for what it still had of the last episode."""
    task = replace(find_task(name).on("pair_straight"), disturbances=Disturbances(), lidar_noise=0.0)
    count = task.actions.space(2).n  # type: ignore[union-attr]  # one number
    batch = BatchEnv(task, count**3, seed=0, autoreset=False)
    batch.reset()
    every = np.arange(count**3)
    for number in range(3):
        step = batch.step(every // count**number % count).transition
        assert not step.hit.any()
        assert not step.in_target.any()


def test_as_they_were_run_the_right_one_has_a_diagonal_twice() -> None:
    for name in PAIRS_AS_RUN:
        task = find_task(name)
        left, right = task.observation.ray_tables(2)[0].tolist()
        assert left[:5] == [45, 43, 47, 22, 68]
        assert right[:5] == [45, 43, 43, 22, 68]
        assert np.bincount(np.array(task.observation.sectors)).tolist() == [
            13,
            13,
            6,
            6,
            6,
            6,
            5,
            5,
            6,
            6,
            6,
            13,
        ]
        with pytest.raises(ValueError, match="different rays"):
            task.observation.mirror_table(2)


@pytest.mark.parametrize("rays", ["[45]", "[45, 43, 47, 22, 91]"])
def test_other_rays_are_as_many(tmp_path: Path, rays: str) -> None:
    text = find_task("wheelchairs-seed-as-run").file.read_text()  # type: ignore[union-attr]  # the kit's tasks are files
    assert "other_rays: [45, 43, 43, 22, 68]" in text
    file = tmp_path / "mine.yaml"
    file.write_text(text.replace("other_rays: [45, 43, 43, 22, 68]", f"other_rays: {rays}"))
    with pytest.raises(WorldError, match="other_rays"):
        read_task(file)


def test_a_task_names_another_world_file_of_its_maps(tmp_path: Path) -> None:
    text = find_task("hallway-seed-as-run").file.read_text()  # type: ignore[union-attr]  # the kit's tasks are files
    file = tmp_path / "mine.yaml"
    file.write_text(text)
    assert {card.world_file.name for card in read_task(file).task.map_cards} == {"as_run.yaml"}
    file.write_text(text.replace("as_run.yaml", "as_runs.yaml"))
    with pytest.raises(WorldError, match="has no file"):
        read_task(file)


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
def test_a_task_is_found_by_its_name(task: LearningTask) -> None:
    assert find_task(task.name) is task
    assert task.map_cases()


def test_the_nearest_name_is_offered() -> None:
    with pytest.raises(UnknownTask, match="hallway"):
        find_task("halway")
    with pytest.raises(UnknownTask, match="left_door"):
        HALLWAY.on("left_dor")
    with pytest.raises(UnknownTask, match="straight"):
        replace(HALLWAY, cases=("strait",)).map_cases()


def test_cases_by_name_and_by_group() -> None:
    def names(task: LearningTask) -> list[str]:
        return [case.name for _, case in task.map_cases()]

    assert len(names(HALLWAY)) == 15
    assert names(HALLWAY.on("doors", "straight")) == ["straight", "left_door", "center_door", "right_door"]
    assert names(HALLWAY.on("90_turns").on("turn_left_90")) == ["turn_left_90"]


@every_case("task", ["turn", "hallway", "wheelchairs"])
@every_case("reward", REWARDS)
def test_any_reward_stays_as_small_as_learning_wants_it(task: str, reward: str) -> None:
    chosen = TaskSpec(task, reward=reward).resolve().reward
    assert chosen.name == reward
    assert chosen.scale == (1.0 if chosen.is_small else REWARD_SCALE)
    assert TaskSpec(task, reward=reward, scale=0.5).resolve().reward.scale == 0.5


@pytest.mark.parametrize("task", ["turn-seed", "hallway-seed", "wheelchairs-seed"])
def test_in_the_dissertations_tasks_its_rewards_are_as_they_were(task: str) -> None:
    assert TaskSpec(task, reward="algorithm-1").resolve().reward.scale == 1.0
    assert TaskSpec(task).resolve() == find_task(task)


def test_what_is_different_survives_as_json() -> None:
    choice = TaskSpec("hallway", ("straight",), measured_to="axle", tells_target=True, reward="progress")
    assert TaskSpec.from_dict(choice.as_dict()) == choice
    with pytest.raises(ValueError, match="not a choice"):
        TaskSpec.from_dict({"task": "hallway", "colour": "red"})


def test_a_reward_that_nobody_knows() -> None:
    with pytest.raises(UnknownTask, match="progress"):
        TaskSpec("hallway", reward="progres").resolve()
