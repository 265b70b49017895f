"""Where a run stands, from its events alone: curves, cases, recent figures, time left, a resume in between."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import pytest

from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.events import (
    Evaluated,
    TrainingEnded,
    TrainingEvent,
    TrainingNote,
    TrainingProgress,
    TrainingStarted,
)
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_status import RECENT_REPORTS, RunPlan, RunStatus, RunTracker, plan_of_run

A, B = "turn_a_to_b", "turn_b_to_a"
PLAN = RunPlan("turn", (A, B), 10_000, 0.9, True)
BATCH = TrainingProgress(
    1000, 1.0, 1200.0, {A: [3, 1, 0], B: [0, 0, 4]}, 2.0, 30.0, {"reached": 4.0, "late": -2.0}
)
TEST = Evaluated(1000, 1.1, {A: [9, 1, 0], B: [5, 0, 5]}, True)


def stands(*events: TrainingEvent, alive: bool = True) -> RunStatus:
    tracker = RunTracker(PLAN)
    for event in events:
        tracker.add(event)
    return tracker.status(alive=alive, order="go")


def batch(steps: int, **changes: object) -> TrainingProgress:
    return replace(BATCH, steps=steps, seconds=steps / 1000, **changes)  # type: ignore[arg-type]  # by name


def test_curves_and_cases() -> None:
    found = stands(TrainingStarted(0.0, 0), BATCH, TEST, batch(2000))
    assert found.batches.steps.tolist() == [1000, 2000]
    assert found.batches.outcomes.tolist() == [[3, 1, 4]] * 2
    assert found.evaluations.mean.tolist() == pytest.approx([0.7])
    assert found.evaluations.worst.tolist() == [0.5]
    assert [(case.name, case.trained, case.last_evaluation) for case in found.cases] == [
        (A, (6, 2, 0), (9, 1, 0)),
        (B, (0, 0, 8), (5, 0, 5)),
    ]
    assert found.summary.state == "running"
    assert found.summary.last_evaluation == TEST


def test_recent_figures_are_weighed_by_episodes_and_forget() -> None:
    many = {A: [30, 10, 0]}
    found = stands(BATCH, batch(2000, episodes=many, reward=8.0, terms={"reached": 8.0}))
    assert found.reward == pytest.approx((8 * 2.0 + 40 * 8.0) / 48)
    assert found.terms == pytest.approx({"reached": (8 * 4.0 + 40 * 8.0) / 48, "late": -2.0})
    later = stands(BATCH, *(batch(2000 + 1000 * k, episodes=many, reward=1.0) for k in range(RECENT_REPORTS)))
    assert later.reward == 1.0


def test_a_batch_without_an_end_of_an_episode_is_no_batch() -> None:
    found = stands(batch(1000, episodes={}, reward=None, length=None, terms={}))
    assert found.batches.outcomes.shape == (0, 3)
    assert found.reward is None
    assert found.terms == {}


def test_time_left_counts_tests_in_and_ends_with_the_training() -> None:
    assert stands(BATCH).remaining_s is None
    assert stands(BATCH, batch(2000)).remaining_s == pytest.approx(8.0)
    slowed = replace(batch(2000), seconds=3.0)
    assert stands(BATCH, slowed).remaining_s == pytest.approx(16.0)
    assert stands(BATCH, batch(2000), alive=False).remaining_s is None


def test_what_a_killed_learner_had_done_since_its_checkpoint_is_gone() -> None:
    found = stands(
        BATCH,
        TEST,
        batch(2000),
        batch(3000),
        replace(TEST, steps=3000),
        TrainingStarted(1.0, 2000),
        batch(2500),
    )
    assert found.batches.steps.tolist() == [1000, 2000, 2500]
    assert found.evaluations.steps.tolist() == [1000]


def test_the_newest_word_is_told() -> None:
    assert stands(BATCH).note == ""
    assert "worst 0.500" in stands(TEST, batch(2000)).note
    assert stands(TEST, TrainingNote("on we go")).note == "on we go"
    assert stands(TrainingNote("compiling", until_progress=True)).note == "compiling"
    assert stands(TrainingNote("compiling", until_progress=True), BATCH).note == ""
    ended = stands(BATCH, TrainingEnded("stopped", 1000, 1.0, "as asked"), alive=False)
    assert (ended.note, ended.summary.state) == ("stopped: as asked", "stopped")


def test_nothing_has_happened_yet() -> None:
    found = stands(alive=False)
    assert found.summary.state == "new"
    assert len(found.evaluations.steps) == len(found.batches.steps) == 0
    assert [sum(case.trained) for case in found.cases] == [0, 0]


def test_the_plan_of_a_run() -> None:
    config = RunConfig(TaskSpec("turn"), seed=3, steps=5000, goal=0.5)
    plan = plan_of_run(config)
    assert (plan.steps, plan.goal, plan.cases) == (5000, 0.5, (A, B))
    assert "seed 3" in plan.title
    assert plan_of_run(replace(config, keep_training=True)).goal is None


@pytest.mark.long
def test_a_face_that_follows_a_run_needs_no_torch() -> None:
    code = (
        "import sys, kit.learning.training.run_status, kit.learning.training.demonstration, kit.learning.training.worker;"
        "print(*{'torch', 'stable_baselines3'} & set(sys.modules))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == []
