"""Cases as arrays: starts that depend on key and number alone, and tasks that do not fit their maps."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.distance_field import CELL, CLEARANCE, compute_distance_field
from kit.learning.maps.batch_map import UnsupportedWorld, load_batch_map
from kit.learning.tasks.catalogue import HALLWAY, TASKS, WHEELCHAIRS
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from kit.world.catalogue import find_map


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
def test_a_start_depends_on_case_key_and_number_alone(task: LearningTask) -> None:
    courses, chance = CaseArrays(task), np.random.default_rng(0)
    cases = chance.integers(len(task.map_cases()), size=50)
    keys, first = chance.integers(2**62, size=50), chance.integers(2**40, size=50)
    together = courses.draw_starts(cases, keys, first)
    for i in range(50):
        alone = courses.draw_starts(cases[i : i + 1], keys[i : i + 1], first[i : i + 1])
        assert alone.poses.tobytes() == together.poses[i : i + 1].tobytes()
        assert alone.targets.tobytes() == together.targets[i : i + 1].tobytes()


def test_noise_reaches_as_far_as_it_should() -> None:
    task = replace(WHEELCHAIRS, start=StartVariation(noise=0.05, max_rotation=0.1))
    cases, keys = np.zeros(4000, dtype=np.int64), np.arange(4000)
    poses = CaseArrays(task).draw_starts(cases, keys, keys).poses
    spread = poses - poses.mean(axis=0)
    assert np.abs(spread).max(axis=(0, 1)) == pytest.approx([0.05, 0.05, 0.1], rel=0.05)
    assert spread.std(axis=(0, 1)) == pytest.approx(np.array([0.05, 0.05, 0.1]) / np.sqrt(3), rel=0.05)
    own = spread.reshape(4000, -1)
    assert np.abs(np.corrcoef(own.T) - np.eye(6)).max() < 0.06


def test_the_number_of_robots_must_be_that_of_the_map() -> None:
    with pytest.raises(UnsupportedWorld, match="has 1 robot, task wheelchairs has 2"):
        CaseArrays(replace(WHEELCHAIRS, maps=("hall_straight",)))


def test_a_map_of_several_cases_stands_once() -> None:
    courses = CaseArrays(HALLWAY.on("90_turns"))
    assert courses.map_of.tolist() == [0, 0, 1, 1]
    assert len(courses.fleet.map_blocks) == 3


@pytest.mark.parametrize("away", [5e3, 2e9])
def test_a_target_far_off_the_map_takes_no_memory(away: float) -> None:
    """As one of a task in somebody else's policy may be: its field would have had up to 1e11 cells in a row."""
    batch_map = load_batch_map(find_map("hall_straight"))
    with pytest.raises(UnsupportedWorld, match="on the map"):
        compute_distance_field(batch_map, (away, 1.0))


def to_go(task: LearningTask, *places: tuple[float, float]) -> list[float]:
    """From these places, on the task's first case."""
    poses = np.array([[(x, y, 0.0)] for x, y in places])
    return CaseArrays(task).to_go(np.zeros(len(places), dtype=np.int64), poses)[:, 0].tolist()


def test_along_a_corridor_it_is_the_distance() -> None:
    (far, near, there) = to_go(HALLWAY.on("straight"), (0.625, 0.5), (0.625, 1.7), (0.625, 2.5))
    assert (far, near, there) == pytest.approx((2.0, 0.8, 0.0), abs=0.01)


def test_across_eight_neighbours_it_is_too_long_by_a_twelfth_at_most() -> None:
    (there,) = to_go(HALLWAY.on("straight"), (0.35, 0.6))
    plain = math.hypot(0.625 - 0.35, 2.5 - 0.6)
    assert plain <= there <= 1.083 * plain


def test_beside_a_wall_a_metre_counts_for_more() -> None:
    straight = HALLWAY.on("straight")
    middle, side = to_go(straight, (0.625, 1.0), (0.15, 1.0))
    along = compute_distance_field(load_batch_map(find_map("hall_straight")), (0.15, 2.0))
    assert side > middle + 0.1
    column = round((0.15 - along.origin[0]) / CELL)
    rows = [round((y - along.origin[1]) / CELL) for y in (1.0, 1.9)]
    lower, upper = (float(along.values[row, column]) for row in rows)
    assert lower - upper > 0.9


@pytest.mark.parametrize("case", ["turn_right_180", "curve_left_180", "left_door", "two_doors"])
def test_it_leads_round_walls(case: str) -> None:
    task = HALLWAY.on(case)
    ((_, course),) = task.map_cases()
    (there,) = to_go(task, course.start[:2])
    plain = math.hypot(course.target[0] - course.start.x, course.target[1] - course.start.y)
    assert there > plain + 0.1 * ("180" in case or "left" in case)
    if "180" in case:
        assert there > 3.0


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
def test_from_every_start_a_way_leads_to_the_target(task: LearningTask) -> None:
    courses = CaseArrays(task)
    number = np.arange(len(task.map_cases()))
    start = courses.draw_starts(number, number, number)
    far = courses.to_go(number, start.poses)
    assert (far > 0.9).all()
    assert (far < 6.0).all()
    there = np.concatenate([start.targets, np.zeros((len(number), 1))], axis=1)[:, None]
    assert (courses.to_go(number, there) <= 0.35 + task.path_end).all()


def test_it_changes_evenly() -> None:
    """No jumps between cells: a step of a centimetre changes it by little more."""
    task = HALLWAY.on("turn_right_90")
    chance = np.random.default_rng(0)
    places = chance.uniform((0.35, 0.35), (0.9, 1.8), (500, 2))
    moved = places + chance.uniform(-0.007, 0.007, (500, 2))
    before = np.array(to_go(task, *map(tuple, places)))
    after = np.array(to_go(task, *map(tuple, moved)))
    assert np.abs(before - after).max() < 0.03


def test_cells_beside_walls_have_a_value() -> None:
    table = compute_distance_field(load_batch_map(find_map("hall_two_doors")), (0.625, 2.5))
    assert np.isfinite(table.values).all()
    assert CLEARANCE > 0.085
