"""Goals and curricula: read with their errors, counted, practised stage by stage, shown, and kept over a checkpoint."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.document.layout import lines_of
from kit.learning.authoring.task_text import task_blocks
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
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
from tests.learning.tasks.tasks_for_tests import one_world, task_of

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


AHEAD, STILL, LEFT = [1.0, 0.0], [0.0, 0.0], [0.0, 1.0]
HALL = "maps: [hall_straight]\ncases:\n  - {start: [0.625, 0.5, 1.5708], "


def drive(batch: BatchEnv, action: list[float], most: int = 200) -> list[BatchStep]:
    """Steps of one action, to the end of the episode."""
    found = []
    for _ in range(most):
        found.append(batch.step(np.array([action])))
        if found[-1].ended[0]:
            break
    return found


def achieved(step: BatchStep) -> float:
    return float(step.transition.achieved[0])


def test_a_patrol_reaches_its_targets_in_their_order() -> None:
    batch = one_world(
        HALL + "targets: [[0.625, 1.0], [0.625, 1.6], [0.625, 2.2]]}\n"
        "goal: {kind: patrol}\ntarget: {radius: 0.1, measured_to: axle}"
    )
    steps = drive(batch, AHEAD)
    shares = [achieved(step) for step in steps]
    assert sorted(set(shares)) == pytest.approx([0.0, 1 / 3, 2 / 3, 1.0])
    assert [step.transition.reached[0] for step in steps] == [False] * (len(steps) - 1) + [True]
    assert EpisodeOutcome.of(steps[-1].transition, 0) is EpisodeOutcome.REACHED
    aims = [tuple(step.transition.target[0].tolist()) for step in steps]
    assert list(dict.fromkeys(aims)) == [(0.625, 1.0), (0.625, 1.6), (0.625, 2.2)]
    progress = sum(float((step.transition.previous_to_go - step.transition.to_go)[0, 0]) for step in steps)
    assert progress == pytest.approx(2.2 - 0.5 - 0.1, abs=0.12)  # nothing is lost where the target changes
    assert sum(float(step.terms["achieving"][0]) for step in steps) == pytest.approx(1.0)


def test_a_patrol_of_two_rounds_comes_back_to_its_first_target() -> None:
    batch = one_world(
        HALL
        + "targets: [[0.625, 0.8], [0.625, 1.4]]}\ngoal: {kind: patrol, rounds: 2}\ntarget: {radius: 0.2}"
    )
    there = drive(batch, AHEAD, 16)
    back = drive(batch, [-1.0, 0.0], 16)
    again = drive(batch, AHEAD, 30)
    assert [achieved(steps[-1]) for steps in (there, back, again)] == pytest.approx([0.5, 0.75, 1.0])


def test_floor_is_covered_once() -> None:
    batch = one_world(
        HALL + "start_shift: [0, 0]}\ngoal: {kind: cover, share: 0.4, radius: 0.2}\nstep: {limit: 60}"
    )
    steps = drive(batch, AHEAD, 20)
    shares = np.array([achieved(step) for step in steps])
    gains = np.diff(shares)
    assert (gains[1:] > 0).all()
    metres = 20 * 0.4 * 0.2
    floor = (1.05 - 0.165) * (2.8 - 0.165)  # where the robot's middle may be
    assert shares[-1] * 0.4 == pytest.approx((metres * 0.4 + math.pi * 0.04) / floor, rel=0.1)
    back = drive(batch, [-1.0, 0.0], 15)
    assert achieved(back[-1]) == shares[-1]
    assert not np.array([step.terms["achieving"][0] for step in back]).any()


@pytest.mark.parametrize(
    ("x", "side", "counts"), [(0.85, "right", True), (0.85, "left", False), (0.4, "left", True)]
)
def test_metres_along_a_wall(x: float, side: str, counts: bool) -> None:
    batch = one_world(
        f"maps: [hall_straight]\ncases: [{{start: [{x}, 0.5, 1.5708]}}]\n"
        f"goal: {{kind: wall, side: {side}, distance: 0.3, tolerance: 0.05, length: 1.0}}"
    )
    steps = drive(batch, AHEAD, 10)
    assert achieved(steps[-1]) == pytest.approx(0.8 * counts)
    if counts:
        assert drive(batch, AHEAD, 3)[-1].transition.reached[0]
    else:
        assert not drive(batch, STILL, 3)[-1].ended[0]


CROSSING = "maps: [crossing]\nmoving_models: as in their files\ncases:\n  - {start: [1.6, 1.2, 1.5708], "


@pytest.mark.long
def test_a_leader_is_a_target_that_moves() -> None:
    batch = one_world(
        CROSSING + "target_model: slow_cart}\ngoal: {kind: follow, nearest: 0.3, farthest: 1.0, time: 2}\n"
        "step: {limit: 100}"
    )
    aims, steps = [batch.state.target[0].tolist()], drive(batch, STILL)
    aims += [step.transition.target[0].tolist() for step in steps]
    assert aims[0] == [1.6, 0.5]
    assert all(x == 1.6 for x, _ in aims)
    heights = np.array([y for _, y in aims])
    duration, time = 8.0, np.arange(len(aims)) * 0.2
    share = time / duration
    assert heights == pytest.approx(
        0.5 + 3.0 * np.where(share < 0.5, 2 * share**2, 1 - (2 - 2 * share) ** 2 / 2), abs=1e-3
    )
    distances = [float(step.transition.distance[0, 0]) for step in steps]
    near = [0.3 <= distance <= 1.0 for distance in distances]
    met = [bool(step.transition.hit[0, 0]) for step in steps]
    counted = np.cumsum([0.2 * (one and not other) for one, other in zip(near, met, strict=True)])
    assert [achieved(step) * 2.0 for step in steps] == pytest.approx(counted.tolist())
    assert met[-1]  # it stands in the cart's way


def test_a_cart_is_kept_away_from() -> None:
    batch = one_world(
        CROSSING + "target: [5.5, 2]}\ngoal: {kind: avoid, distance: 0.5, time: 3}\nstep: {limit: 100}"
    )
    steps = drive(batch, STILL)
    nearest = [float(step.transition.obstacle_distance[0, 0]) for step in steps]
    assert min(nearest) < 0.4
    assert achieved(steps[-1]) * 3.0 == pytest.approx(0.2 * sum(each > 0.5 for each in nearest))


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


@pytest.mark.parametrize(("heading", "reached"), [(1.5708, True), (0.0, False)])
def test_parking_takes_the_targets_heading(heading: float, reached: bool) -> None:
    batch = one_world(
        HALL
        + f"target: [0.625, 0.7], target_heading: {heading}}}\ngoal: {{kind: target, heading_tolerance: 0.2}}\n"
        "target: {radius: 0.3}"
    )
    step = batch.step(np.array([STILL]))
    assert (bool(step.transition.reached[0]), bool(step.transition.in_target[0, 0])) == (reached, reached)
    assert float(step.transition.misalignment[0, 0]) == pytest.approx(abs(heading - 1.5708), abs=1e-4)


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
