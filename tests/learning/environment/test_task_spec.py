"""A task, and what is different from it."""

from __future__ import annotations

import pytest

from kit.learning.environment.rewards import REWARD_SCALE, REWARDS
from kit.learning.environment.task_spec import TaskSpec
from kit.learning.environment.tasks import UnknownTask, find_task
from tests.cases import every_case


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
    with pytest.raises(ValueError, match="no choice"):
        TaskSpec.from_dict({"task": "hallway", "colour": "red"})


def test_a_reward_that_nobody_knows() -> None:
    with pytest.raises(UnknownTask, match="progress"):
        TaskSpec("hallway", reward="progres").resolve()
