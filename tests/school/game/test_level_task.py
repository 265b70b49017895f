"""Tasks made from levels: each asks for what its level asks for, in the level's world."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.learning.authoring.task_check import check_task
from kit.learning.environment.batch import BatchEnv
from kit.learning.policies.policy_node import node_refusals
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_reader import read_task
from kit.school.game.level_task import task_text
from kit.school.game.levels import GameLevel, all_levels, find_level
from kit.school.game.task_levels import task_level
from kit.sim.plugins.tween import TweenParams
from kit.world.records import World

LEVELS = [pytest.param(each, id=each.id) for each in all_levels()]


def task_of(level: GameLevel, folder: Path) -> LearningTask:
    file = folder / "task.yaml"
    file.write_text(task_text(level))
    read = read_task(file)
    check_task(read)
    return read.task


def moving(world: World) -> dict[str, tuple[object, ...]]:
    """Where the models start that move by themselves, and how they go."""
    return {
        model.name: (model.pose, plugin.params)
        for model in world.models
        for plugin in model.plugins
        if isinstance(plugin.params, TweenParams)
    }


@pytest.mark.sampled(8)
@pytest.mark.parametrize("level", LEVELS)
def test_a_levels_task_is_sound_and_can_be_raced(level: GameLevel, tmp_path: Path) -> None:
    task, scenario = task_of(level, tmp_path), level.find_scenario()
    assert node_refusals(task) == ()
    raced = task_level(tmp_path / "task.yaml")
    assert moving(raced.find_scenario().world) == moving(scenario.world)
    assert (task.robots, task.maps) == (len(scenario.starts), (level.map_name,))
    (_, case), *_ = task.map_cases()
    for places, pose in zip(case.starts, scenario.starts, strict=True):
        assert tuple(places.poses[0]) == pytest.approx(tuple(pose), abs=1e-4)
    if not level.conditions.charge:
        assert (task.goal, case.targets.model or "") == (level.goal, level.leader)
    for place in level.targets:
        assert place in task.route(case)
    assert len(BatchEnv(task, 2).reset()) == 2


def test_what_a_level_has_of_its_own_is_in_the_training(tmp_path: Path) -> None:
    assert task_of(find_level("black-ice"), tmp_path).disturbances.inertia.low == pytest.approx(
        1 / 0.3, abs=1e-3
    )
    low = task_of(find_level("low-battery"), tmp_path)
    assert low.route(low.map_cases()[0][1]) == ((3.85, 2.25), (0.6, 0.45))
    nurse = BatchEnv(task_of(find_level("follow-the-nurse"), tmp_path), 1)
    nurse.reset()
    assert nurse.obstacle_poses(0)[0, :2] == pytest.approx(nurse.state.target[0])
