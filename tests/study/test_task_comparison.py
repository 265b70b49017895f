"""In what two tasks test agents differently."""

from __future__ import annotations

from dataclasses import replace

import pytest

from kit.learning.tasks.catalogue import HALLWAY, WHEELCHAIRS, find_task
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from kit.study.task_comparison import test_differences as differences


@pytest.mark.parametrize(
    ("other", "what"),
    [
        (replace(HALLWAY, target_radius=0.3), "target radius"),
        (replace(HALLWAY, max_steps=300), "steps of an episode"),
        (replace(HALLWAY, step_time=0.1), "seconds of a step"),
        (HALLWAY.on("doors"), "cases"),
        (replace(HALLWAY, actions=find_task("turn").actions), "actions"),
        (replace(HALLWAY, measured_to="axle"), "measured to"),
    ],
)
def test_what_is_to_be_done_is_compared(other: LearningTask, what: str) -> None:
    (found,) = differences(HALLWAY, other)
    assert what in found


def test_what_is_learned_from_is_not() -> None:
    assert differences(HALLWAY, find_task("hallway-seed-as-run")) == []
    assert differences(WHEELCHAIRS, find_task("wheelchairs-seed-as-run")) == []


def test_a_gap_is_the_map_s_unless_the_task_has_one() -> None:
    first = find_task("wheelchairs-seed-49")
    assert differences(first, replace(first, start=StartVariation(gap=0.3))) == []
    assert len(differences(first, replace(first, start=StartVariation(gap=0.4)))) == 1
