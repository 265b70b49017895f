"""A curriculum: read with its errors, practised stage by stage, shown, and kept over a checkpoint."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.learning.environment.batch_map import UnsupportedWorld
from kit.learning.environment.tasks import TaskSpec, find_task
from kit.learning.tasks.learning_task import CurriculumStage, practices
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_text import describe_task
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.events import TrainingNote
from kit.learning.training.presets import find_preset
from kit.learning.training.runs import RunConfig, create_run
from kit.learning.training.training import make_learner, train
from kit.world.problems import WorldError

TASK = """
maps: [hall_straight, hall_left_door, hall_center_door]
actions: {twists: {forward: [0.3, 0], left: [0, 1.05], right: [0, -1.05]}}
observation: {sectors: 9}
reward: {name: progress}
curriculum:
  - {on: [straight], success: 0.01}
  - {on: [straight, doors]}
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "task.yaml"
    file.write_text(text)
    return file


def test_stages_are_read_and_shown(tmp_path: Path) -> None:
    task = read_task(written(tmp_path, TASK)).task
    assert task.curriculum == (
        CurriculumStage(("straight",), 0.01),
        CurriculumStage(("straight", "doors"), 0.9),
    )
    shown = "\n".join(describe_task(task))
    assert "1. straight, until each succeeds in 0.01" in shown
    assert "3. all cases" in shown
    assert "learns" not in "\n".join(describe_task(find_task("turn")))


MISTAKES = {
    "unknown case": ("on: [straight]", "on: [strait]", ":7:", 'did you mean "?straight'),
    "no cases": ("on: [straight], ", "", ":7:", "on"),
    "too much": ("success: 0.01", "success: 2", ":7:", "success"),
    "unknown key": ("success: 0.01", "until: 0.01", ":7:", "until"),
    "no list": ("- {on: [straight], success: 0.01}\n  - {on: [straight, doors]}", "straight", ":7:", "list"),
}


@pytest.mark.parametrize(("good", "bad", "place", "told"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_told_with_its_place(good: str, bad: str, place: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(WorldError, match=told) as error:
        read_task(written(tmp_path, TASK.replace(good, bad)))
    assert place in str(error.value)


def test_a_stage_practises_its_cases_alone() -> None:
    cases = [("straight", ""), ("left_door", "doors"), ("right_door", "doors")]
    curriculum = (CurriculumStage(("doors",), 0.5), CurriculumStage(("turns",), 0.5))
    (stage,) = practices(curriculum, cases)
    assert stage.world_shares([name for name, _ in cases]).tolist() == [0, 0.5, 0.5]
    assert stage.is_over({"straight": 0.0, "left_door": 0.5, "right_door": 1.0})
    assert not stage.is_over({"straight": 1.0, "left_door": 0.4, "right_door": 1.0})


def test_worlds_practise_what_they_are_dealt(tmp_path: Path) -> None:
    choice = TaskSpec(str(written(tmp_path, TASK))).frozen()
    task, algorithm = choice.resolve(), find_algorithm("q-learning")
    preset = replace(find_preset("kit", algorithm, ""), worlds=6)
    learner = make_learner(algorithm, preset, choice, task, seed=1)
    cases = [(case.name, case.group) for _, case in task.map_cases()]
    names = [name for name, _ in cases]
    learner.assign_cases(practices(task.curriculum, cases)[0].world_shares(names))
    batch = learner._batch  # type: ignore[attr-defined]  # where it drives
    batch.reset()
    assert set(batch.state.case.tolist()) == {0}
    learner.assign_cases(np.full(3, 1 / 3))
    batch.reset()
    assert sorted(batch.state.case.tolist()) == [0, 0, 1, 1, 2, 2]
    with pytest.raises(UnsupportedWorld, match="--worlds 3"):
        make_learner(algorithm, replace(preset, worlds=2), choice, task, seed=1)


@pytest.mark.long
def test_training_goes_from_stage_to_stage_and_remembers_where_it_is(tmp_path: Path) -> None:
    choice = TaskSpec(str(written(tmp_path, TASK.replace("0.01}", "0.0001}"))))
    config = RunConfig(choice, "q-learning", seed=1, steps=150_000, keep_training=True)
    run = create_run(tmp_path, config, "staged")
    with pytest.raises(KeyboardInterrupt):
        train(run, interrupted=lambda: run.summary().steps > 60_000)
    assert train(run).how == "finished"
    notes = [event.text for event in run.events() if isinstance(event, TrainingNote)]
    stages = [note for note in notes if note.startswith("Stage")]
    assert stages[0].startswith("Stage 1 of 3: straight")
    assert any(stage.startswith("Stage 2 of 3") for stage in stages)
    assert [stage.split()[1] for stage in stages] == sorted(stage.split()[1] for stage in stages)
