"""Any map trains: a task made from it steps in the batch engine as it does in the single world."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.geometry import Pose
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_map import UnsupportedWorld, load_batch_map
from kit.learning.environment.tasks import LearningTask, StartVariation
from kit.learning.tasks.task_check import check_task
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_template import new_task_file
from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.simulation import Simulation, load_world
from kit.world.catalogue import all_maps, find_map

NAMES = [card.name for card in all_maps()]
REFUSED = {"depot": "no joints", "f1tenth": "no joints", "turtlebot": "lidar at the origin"}
"""Maps that the batch engine cannot represent, and why."""


def made(name: str, folder: Path) -> LearningTask:
    """A task made from a map, without chance."""
    read = read_task(new_task_file("mine", name, folder))
    check_task(read)
    exact = StartVariation(shifted=False)
    return replace(read.task, start=exact, lidar_noise=0.0, random_phase=False, max_steps=60)


@pytest.mark.sampled(12)
@pytest.mark.parametrize("name", [name for name in NAMES if name not in REFUSED])
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


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_trained_says_why(name: str) -> None:
    with pytest.raises(UnsupportedWorld, match=REFUSED[name]):
        load_batch_map(find_map(name))
