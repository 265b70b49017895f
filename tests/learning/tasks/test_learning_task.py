"""Curricula: read with their errors, practised stage by stage, shown, and kept over a checkpoint; what agents see and meet."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.document.layout import lines_of
from kit.learning.authoring.task_text import task_blocks
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.curriculum import CurriculumStage, practices
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.events import TrainingNote
from kit.learning.training.presets import find_preset
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.training import make_learner, train
from kit.world.problems import WorldError
from tests.learning.tasks.tasks_for_tests import CROSSING, HALL, STILL, drive, one_world, task_of

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
    shown = "\n".join(lines_of(task_blocks(task)))
    assert "1. straight, until each has a success rate of 0.01" in shown
    assert "3. all cases" in shown
    assert "learns" not in "\n".join(lines_of(task_blocks(find_task("turn"))))


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


def test_a_cart_is_seen_and_met_wherever_its_way_begins() -> None:
    text = CROSSING.replace("moving_models: as in their files\n", "") + "target: [5.5, 2]}"
    batch = BatchEnv(task_of(text), 200, seed=1, autoreset=False)
    batch.reset()
    assert np.ptp(batch.state.phase) > 0.9
    step = batch.step(np.zeros((200, 2)))
    seen = step.transition.ranges[:, 0].min(axis=1)
    near = step.transition.obstacle_distance[:, 0]
    in_sight = (near > 0.2) & (near < 0.5)
    assert in_sight.any()
    assert seen[in_sight] == pytest.approx(near[in_sight] - 0.15, abs=0.02)


@pytest.mark.parametrize("ending", ["terminated", "truncated", "continues"])
def test_what_a_collision_means(ending: str) -> None:
    batch = one_world(HALL + f"target: [0.625, 1]}}\nendings: {{collision: {ending}}}\nstep: {{limit: 40}}")
    steps = drive(batch, [-1.0, 0.0])
    last = steps[-1]
    assert last.transition.collided[0]
    assert bool(last.terminated[0]) == (ending == "terminated")
    assert bool(last.truncated[0]) == (ending != "terminated")
    assert (len(steps) == 40) == (ending == "continues")
    outcome = EpisodeOutcome.of(last.transition, 0)
    assert outcome is (EpisodeOutcome.TIMED_OUT if ending == "continues" else EpisodeOutcome.COLLIDED)


SEEING = """\
actions: {linear: [-0.4, 0.4], angular: [-1.5, 1.5]}
observation: {rays: [45], speeds: true, last_action: true, own_pose: true, target: true, achieved: true, frames: 2, scale: 0.5}
reward: {terms: {reached: 1}}
lidar_noise: 0
"""


def test_what_an_agent_may_see_of_itself() -> None:
    batch = one_world(HALL + "target: [0.625, 2.5]}\nstep: {time: 0.1}", SEEING)
    first = batch.step(np.array([[0.5, 0.2]])).observations[0].reshape(2, 12)
    ray, forward, turn, asked, asked_turn, x, y, cos, sin, share, distance, bearing = first[1].tolist()
    pose = batch.state.pose[0, 0]
    assert (forward, turn) == pytest.approx((0.2, 0.3), abs=1e-3)
    assert (asked, asked_turn) == pytest.approx((0.2, 0.3))
    assert (x, y, cos, sin) == pytest.approx(
        (pose[0] / 2, pose[1] / 2, math.cos(pose[2]), math.sin(pose[2])), abs=1e-6
    )
    assert (ray, distance, share) == pytest.approx(
        (1.0, 0.5 * math.hypot(pose[0] - 0.625, pose[1] - 2.5), 0.0)
    )
    assert bearing == pytest.approx(-0.03 / math.pi, abs=2e-3)
    assert first[0, 1:3].tolist() == [0.0, 0.0]  # the frame before, when it stood
    second = batch.step(np.array([STILL])).observations[0].reshape(2, 12)
    assert second[0].tolist() == first[1].tolist()
    assert batch.observation_space.contains(second.reshape(-1))


@pytest.mark.long
def test_places_are_drawn_from_the_floor() -> None:
    text = "maps: [house]\ncases: [{start_anywhere: true, target_anywhere: true}]\ntarget: {radius: 0.15}"
    batch = BatchEnv(task_of(text), 400, seed=2)
    batch.reset()
    poses, targets = batch.state.pose[:, 0], batch.state.target
    assert np.ptp(poses[:, 0]) > 4
    assert len(np.unique(targets.round(1), axis=0)) > 30
    assert np.ptp(poses[:, 2]) > 6
    assert not batch.state.in_target.any()
    assert not batch.step(np.zeros((400, 2))).transition.hit.any()
    straight = np.hypot(*(poses[:, :2] - targets).T)
    assert (batch.state.to_go[:, 0] > straight - 0.3).all()
    in_one_room = BatchEnv(
        task_of(
            "maps: [house]\ncases: [{start_area: [-0.3, -0.6, 0.4, 0.3], start_headings: [0, 1], target: [2, -1.6]}]"
        ),
        200,
        seed=1,
    )
    in_one_room.reset()
    x, y, theta = in_one_room.state.pose[:, 0].T
    assert (x.min() >= -0.33, x.max() <= 0.43, y.min() >= -0.63, y.max() <= 0.33) == (True,) * 4
    assert (theta.min() >= 0, theta.max() <= 1, np.ptp(theta) > 0.8) == (True,) * 3
