"""Cases as arrays: starts that depend on key and number alone, and tasks that do not fit their maps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.batch_map import UnsupportedWorld
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.tasks import HALLWAY, TASKS, WHEELCHAIRS, LearningTask, StartVariation


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
    with pytest.raises(UnsupportedWorld, match="has 1 robots, task wheelchairs 2"):
        CaseArrays(replace(WHEELCHAIRS, maps=("hall_straight",)))


def test_a_map_of_several_cases_stands_once() -> None:
    courses = CaseArrays(HALLWAY.on("90_turns"))
    assert courses.map_of.tolist() == [0, 0, 1, 1]
    assert len(courses.fleet.map_blocks) == 3
