"""Any map trains: a task made from it steps in the batch engine as it does in the single world."""

from __future__ import annotations

import math
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from kit.geometry import Pose
from kit.learning.authoring.new_task import new_task_file
from kit.learning.authoring.task_check import check_task
from kit.learning.environment.batch import BatchEnv
from kit.learning.maps.batch_map import UnsupportedWorld, load_batch_map
from kit.learning.maps.ray_directions import RAY_COUNT, ray_direction
from kit.learning.policies.evaluation import Evaluator
from kit.learning.tasks.actions import ContinuousActions
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.training import train
from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.plugins.laser import LaserParams
from kit.sim.simulation import STEP_SIZE_S, Simulation, load_world
from kit.world.catalogue import find_map
from tests.kit_content import kit_maps

NAMES = [card.name for card in kit_maps()]
REFUSED = {"f1tenth": "steered at once"}
"""Maps that the batch engine cannot represent, and why."""
TRICYCLES = "depot"
"""Whose robot turns a tick after it is steered, and by some thousandths of a radian when its wheel jumps."""


def made(name: str, folder: Path) -> LearningTask:
    """A task made from a map, without chance."""
    read = read_task(new_task_file("mine", name, folder))
    check_task(read)
    exact = StartVariation(shifted=False)
    return replace(read.task, start=exact, lidar_noise=0.0, random_phase=False, max_steps=60)


@pytest.mark.sampled(12)
@pytest.mark.parametrize("name", [name for name in NAMES if name not in (*REFUSED, TRICYCLES)])
def test_a_task_of_any_map_steps_in_both_engines_alike(name: str, tmp_path: Path) -> None:
    task = made(name, tmp_path)
    batch, card = BatchEnv(task, 1, seed=0, autoreset=False), find_map(name)
    batch.reset()
    models = task.robots_on(card)
    tick = task.step_time / task.collision_checks
    world = load_world(card.world_file, root=card.root)
    topics = [next(model.topic("cmd_vel") for model in world.models if model.name == each) for each in models]
    simulation = Simulation(world, step_size=tick, has_subscribers=lambda topic: False)
    for robot, pose in zip(models, batch.state.pose[0].tolist(), strict=True):
        simulation.move_model(robot, Pose(*pose))
    chance = np.random.default_rng(len(name))
    for _ in range(task.max_steps):
        action = chance.integers(len(task.actions.names) ** task.robots, size=1)
        step = batch.step(action)
        for topic, (forward, turn) in zip(topics, step.transition.twist[0].tolist(), strict=True):
            simulation.accept(topic, Twist(linear=Vector3(x=forward), angular=Vector3(z=turn)))
        for _ in range(task.collision_checks):
            simulation.step()
        if step.transition.hit.any():
            return  # when and where collisions come is for the test of parity
        single = np.array([simulation.pose(robot) for robot in models])
        assert np.abs(single - step.transition.pose[0]).max() < 1e-9
        if step.ended[0]:
            return


def test_every_action_of_a_tricycle_is_alike_in_both_engines(tmp_path: Path) -> None:
    task, card = made(TRICYCLES, tmp_path), find_map(TRICYCLES)
    (robot,) = task.robots_on(card)
    world = load_world(card.world_file, root=card.root)
    topic = next(model.topic("cmd_vel") for model in world.models if model.name == robot)
    ways = []
    for action in range(len(task.actions.names)):
        batch = BatchEnv(task, 1, seed=0, autoreset=False)
        batch.reset()
        simulation = Simulation(world, step_size=STEP_SIZE_S, has_subscribers=lambda topic: False)
        simulation.move_model(robot, Pose(*batch.state.pose[0, 0].tolist()))
        speed, angle = task.actions.twists[action].tolist()
        for forward in (0.0, speed):
            simulation.accept(topic, Twist(linear=Vector3(x=forward), angular=Vector3(z=angle)))
            simulation.step()  # the wheel is where it is wanted, and then it begins to drive
        ticks = round(task.step_time / STEP_SIZE_S)
        for number in range(5):
            step = batch.step(np.array([action])).transition
            if step.hit.any():
                break
            simulation.step(ticks - 1 if number == 0 else ticks)
            assert np.abs(np.array(simulation.pose(robot)) - step.pose[0, 0]).max() < 1e-5
        ways.append(number)
    assert min(ways[:3]) == 4


@pytest.mark.long
@pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")
@pytest.mark.parametrize("name", [name for name in NAMES if name not in REFUSED])
def test_a_task_of_any_map_trains(name: str, tmp_path: Path) -> None:
    task_file = new_task_file("mine", name, tmp_path)
    run = create_run(tmp_path, RunConfig(TaskSpec(str(task_file)), steps=20_000))
    ended = train(run)
    assert ended.how == "finished"
    assert ended.reason.startswith("all steps are done, but ")
    policy = run.policy()
    result = Evaluator(policy.trained_on.resolve()).test(policy, episodes=20, seed=1)
    assert all(case.episodes == 20 for case in result.cases)


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_trained_says_why(name: str) -> None:
    with pytest.raises(UnsupportedWorld, match=REFUSED[name]):
        load_batch_map(find_map(name))


def test_a_lidar_off_the_robots_origin_reads_the_same_in_both_engines(tmp_path: Path) -> None:
    task, card = made("turtlebot", tmp_path), find_map("turtlebot")
    world, chance = load_world(card.world_file, root=card.root), np.random.default_rng(1)
    burger = world.models[0]
    silent = tuple(
        replace(each, params=replace(each.params, noise=0.0))
        if isinstance(each.params, LaserParams)
        else each
        for each in burger.plugins
    )
    simulation = Simulation(replace(world, models=(replace(burger, plugins=silent),)), step_size=0.2)
    batch = BatchEnv(task, 1, seed=0, autoreset=False)
    batch.reset()
    rays = [round(math.degrees(ray_direction(ray))) % 360 for ray in range(RAY_COUNT)]
    for _ in range(20):
        step = batch.step(chance.integers(len(task.actions.names), size=1))
        simulation.move_model("burger", Pose(*step.transition.pose[0, 0].tolist()), at_rest=True)
        simulation.step()
        (scan,) = simulation.latest_scans()
        seen = np.minimum(scan.ranges[rays], task.observation.clip)
        assert np.abs(seen - step.transition.ranges[0, 0]).max() < 1e-4


def test_actions_beyond_the_motors_are_refused(tmp_path: Path) -> None:
    task = made("turtlebot", tmp_path)
    fast = replace(task, actions=ContinuousActions((0.0, 0.3), (-1.0, 1.0)))
    with pytest.raises(UnsupportedWorld, match=r"at most 0\.22 m/s"):
        BatchEnv(fast, 1, seed=0)
