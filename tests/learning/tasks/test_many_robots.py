"""One to four robots that one agent drives, and worlds with thousands of walls."""

from __future__ import annotations

import shutil
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from kit.geometry import Pose
from kit.learning.authoring.task_check import check_task
from kit.learning.environment.batch import BatchEnv
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_reader import read_task
from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.simulation import Simulation, load_world
from kit.world.catalogue import maps_folder
from kit.world.problems import WorldError

NAMES = ("first", "second", "third", "fourth")
PLACES = [Pose(0.4 + 0.3 * (k % 2), 0.6 + 0.5 * (k // 2), 1.5708) for k in range(4)]


def written(folder: Path, robots: int, places: list[Pose] = PLACES) -> Path:
    """A task for so many robots in a hall of its own."""
    shutil.copytree(maps_folder() / "robots", folder / "robots")
    for file in (maps_folder() / "hall_straight").glob("map.*"):
        shutil.copy(file, folder)
    models = "".join(
        f"  - {{name: {name}, model: robots/left.model.yaml, namespace: {name}, pose: [{x}, {y}, {theta}]}}\n"
        for name, (x, y, theta) in zip(NAMES[:robots], places, strict=False)
    )
    (folder / "world.yaml").write_text(
        "properties: {}\nlayers:\n  - {name: [seen, felt], map: map.yaml}\n  - {name: tracked}\nmodels:\n"
        + models
    )
    others = [list(each) for each in places[1:robots]]
    (folder / "mine.yaml").write_text(
        f"world: world.yaml\nrobots: [{', '.join(NAMES[:robots])}]\n"
        f"cases:\n  - {{start: {list(places[0])}, other_starts: {others}, target: [0.625, 2.5]}}\n"
        "actions: {twists: {ahead: [0.3, 0], left: [0, 1], right: [0, -1]}, one_number: false}\n"
        "observation: {sectors: 9, target: true}\nreward: {terms: {progress: 1}}\nlidar_noise: 0\n"
    )
    return folder / "mine.yaml"


def task_of(file: Path) -> LearningTask:
    read = read_task(file)
    check_task(read)
    return read.task


@pytest.mark.parametrize("robots", [3, 4])
def test_several_robots_step_in_both_engines_alike(robots: int, tmp_path: Path) -> None:
    task = task_of(written(tmp_path, robots))
    batch = BatchEnv(task, 1, seed=0, autoreset=False)
    seen = batch.reset()
    assert seen.shape == (1, robots * task.observation.size)
    simulation = Simulation(
        load_world(tmp_path / "world.yaml"), step_size=0.1, has_subscribers=lambda topic: False
    )
    chance = np.random.default_rng(1)
    for _ in range(12):
        step = batch.step(chance.integers(3, size=(1, robots)))
        if step.transition.hit.any():
            break
        for name, (forward, turn) in zip(NAMES, step.transition.twist[0].tolist(), strict=False):
            simulation.accept(f"/{name}/cmd_vel", Twist(linear=Vector3(x=forward), angular=Vector3(z=turn)))
        simulation.step()
        simulation.step()
        single = np.array([simulation.pose(name) for name in NAMES[:robots]])
        assert np.abs(single - step.transition.pose[0]).max() < 1e-9
    assert step.transition.step[0] > 3


def test_robots_see_and_meet_one_another_and_the_others_go_on(tmp_path: Path) -> None:
    places = [Pose(0.4, 0.6, 1.5708), Pose(0.4, 1.0, -1.5708), Pose(0.9, 0.6, 1.5708)]
    task = replace(task_of(written(tmp_path, 3, places)), collision_ending="continues")
    batch = BatchEnv(task, 1, seed=0, autoreset=False)
    batch.reset()
    step = batch.step(np.ones((1, 3), dtype=np.int64) * 0)
    assert step.transition.front[0, 0] == pytest.approx(0.4 - 2 * 0.06 - 0.048, abs=0.01)
    for _ in range(5):
        step = batch.step(np.zeros((1, 3), dtype=np.int64))
    assert step.transition.hit[0].tolist() == [True, True, False]
    assert batch.state.pose[0, 2, 1] == pytest.approx(0.6 + 6 * 0.06)


def test_starts_that_touch_one_another_are_refused(tmp_path: Path) -> None:
    places = [Pose(0.4, 0.6, 1.5708), Pose(0.45, 0.6, 1.5708), Pose(0.9, 0.6, 1.5708)]
    with pytest.raises(WorldError, match="another robot"):
        task_of(written(tmp_path, 3, places))


@pytest.mark.long
def test_a_world_of_several_thousand_walls(tmp_path: Path) -> None:
    file = written(tmp_path, 1)
    chance = np.random.default_rng(0)
    posts = [(x, y) for x in np.arange(0.6, 11.0, 0.6) for y in np.arange(0.6, 11.0, 0.6)]
    lines = [(0.0, 0.0, 12.0, 0.0), (12.0, 0.0, 12.0, 12.0), (12.0, 12.0, 0.0, 12.0), (0.0, 12.0, 0.0, 0.0)]
    for x, y in posts:
        angles = np.linspace(0, 2 * np.pi, 17) + chance.uniform(0, 1)
        ring = np.stack([x + 0.08 * np.cos(angles), y + 0.08 * np.sin(angles)], axis=1)
        lines += [(*one, *other) for one, other in pairwise(ring.tolist())]
    (tmp_path / "walls.dat").write_text("\n".join(" ".join(f"{each:.4f}" for each in line) for line in lines))
    (tmp_path / "map.yaml").write_text("type: line_segments\ndata: walls.dat\nscale: 1\norigin: [0, 0, 0]\n")
    text = file.read_text().replace(
        "start: [0.4, 0.6, 1.5708], other_starts: [], target: [0.625, 2.5]",
        "start_anywhere: true, target: [11.5, 11.5]",
    )
    file.write_text(text)
    task = task_of(file)
    batch = BatchEnv(task, 64, seed=1)
    batch.reset()
    assert len(batch.map_of_case(0)[1].walls) > 4000
    assert np.ptp(batch.state.pose[:, 0, 0]) > 8
    for _ in range(60):
        step = batch.step(np.random.default_rng(2).integers(3, size=64))
    assert np.isfinite(step.rewards).all()
