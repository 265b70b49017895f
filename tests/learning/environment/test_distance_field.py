"""The way to a target: as the crow flies where it can, round walls where it must, never through them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.learning.environment.batch_map import load_batch_map
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.distance_field import CELL, CLEARANCE, compute_distance_field
from kit.learning.environment.tasks import HALLWAY, TASKS, LearningTask
from kit.world.catalogue import find_map


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
