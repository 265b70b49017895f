"""Task files beside an assignment: what is to be learned, trained for or written as an environment is posed in one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grader.evidence.submission_clock import SubmissionClock
from grader.kinds.environment.examination import EnvironmentTask
from grader.kinds.reward.reward_training import RewardTrainingParams, mean_success
from grader.kinds.training.trainings import TrainingBudget
from grader.reading import read_assignment
from grader.task_files import assignment_task, task_scenario
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.learning_task import UnknownTask
from kit.mapmaking.map_drawing import read_drawing
from kit.mapmaking.new_map import write_map
from kit.world.problems import WorldError

DRAWING = "########\n#S    T#\n#      #\n########"
TASK = """\
summary: To the other side
world: room/world.yaml
cases:
  - {name: across, start: [0.75, 1.25, 0], target: [3.25, 1.25]}
  - {name: back, start: [3.25, 1.25, 3.14159], target: [0.75, 1.25]}
actions: {twists: {forward: [0.4, 0], left: [0, 1.2], right: [0, -1.2]}}
observation: {sectors: 5, clip: 1.5}
reward: {terms: {progress: 1.0, reached: 2.0, collided: -2.0}}
goal: {kind: target}
step: {time: 0.2, limit: 60}
"""
TRAINING = """\
title: A task of our own
kind: training
submit: training.yaml
level: 0
training: {task: TASK, steps: 5000, seeds: [1], episodes: 20}
checks: [{check: succeeds, points: 1}]
"""
ENVIRONMENT = """\
title: Write it
kind: environment
submit: env.py
level: 0
environment: {class: Mine, task: TASK, way: [[0.75, 1.25], [3.25, 1.25]]}
checks: [{check: spaces, points: 1}]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "assignment"
    write_map(made / "room", read_drawing(DRAWING), title="Room", source="drawn")
    (made / "across.yaml").write_text(TASK)
    return made


def pose(folder: Path, text: str, task: str) -> Path:
    (folder / "assignment.yaml").write_text(text.replace("TASK", task))
    return folder


@pytest.mark.long
def test_a_training_is_of_the_task_beside_it_wherever_the_grader_runs(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    budget = read_assignment(pose(folder, TRAINING, "across.yaml")).task
    assert isinstance(budget, TrainingBudget)
    assert budget.cases == ("across", "back")
    assert budget.choice.resolve().name == "across"
    assert read_assignment(pose(folder, TRAINING, "turn")).task.cases == ("turn_a_to_b", "turn_b_to_a")


def test_an_environment_takes_place_actions_and_times_from_the_task(folder: Path) -> None:
    task = read_assignment(pose(folder, ENVIRONMENT, "across.yaml, case: back")).task
    assert isinstance(task, EnvironmentTask)
    assert task.moves == ((0.4, 0.0), (0.0, 1.2), (0.0, -1.2))
    assert (task.step_s, task.max_steps, task.clip) == (0.2, 60, 1.5)
    scenario = task.scenario
    assert scenario.start is not None
    assert scenario.case is not None
    assert scenario.start == pytest.approx((3.25, 1.25, 3.14159))
    assert scenario.case.target == (0.75, 1.25)


@pytest.mark.parametrize(
    ("text", "task", "words"),
    [
        (TRAINING, "acros.yaml", "nor a file"),
        (TRAINING, "../secret.yaml", "nor a file"),
        (TRAINING, "broken.yaml", r"broken\.yaml:4"),
        (ENVIRONMENT, "wheelchairs", "one robot"),
        (ENVIRONMENT, "smooth-turn", "discrete actions"),
        (ENVIRONMENT, "across.yaml, case: bak", "back"),
    ],
)
def test_a_teachers_mistake_is_told_when_read(folder: Path, text: str, task: str, words: str) -> None:
    (folder.parent / "secret.yaml").write_text(TASK)
    (folder / "broken.yaml").write_text(TASK.replace("start: [0.75, 1.25, 0]", "start: [0.0, 1.25, 0]"))
    with pytest.raises(WorldError, match=words) as told:
        read_assignment(pose(folder, text, task))
    assert "assignment.yaml" in str(told.value)


@pytest.mark.long
def test_a_reward_is_trained_with_on_the_task_beside_it(folder: Path) -> None:
    budget = RewardTrainingParams("across.yaml", steps=20_000, seeds=1, episodes=20)
    clock = SubmissionClock()

    def useful(transition: object) -> np.ndarray:
        return transition.previous_to_go.sum(axis=-1) - transition.to_go.sum(axis=-1)  # type: ignore[attr-defined]  # as a student would write it: untyped

    assert mean_success(useful, budget, clock, folder) > 0.5
    with pytest.raises(UnknownTask):
        mean_success(useful, budget, clock, folder.parent)


def test_the_kits_tasks_have_scenarios_too() -> None:
    scenario = task_scenario(find_task("hallway"), "left_door")
    assert scenario.case is not None
    assert scenario.case.name == "left_door"
    assert assignment_task("hallway", Path("/nowhere")).task == "hallway"
