"""Tasks: their figures are those of the dissertation, and parts of them can be chosen by name."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from kit.learning.environment.actions import Move
from kit.learning.environment.rewards import ALGORITHM_1, ALGORITHM_2, ALGORITHM_3
from kit.learning.environment.tasks import (
    HALLWAY,
    HALLWAY_SEED,
    TASKS,
    TURN_SEED,
    WHEELCHAIRS_SEED,
    WHEELCHAIRS_SEED_49,
    LearningTask,
    UnknownTask,
    find_task,
)


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
