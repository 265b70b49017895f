"""The newest policy at the wheel: case after case, a newer policy from the next episode on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.policies.policy import ActionSampling, Policy, PolicyError, task_interface
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.demonstration import Demonstration
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun

FORWARD, LEFT = 0, 1


def always(move: int, steps: int) -> Policy:
    """Of the task *turn*, whatever it sees."""
    bias = np.zeros(3, dtype=np.float32)
    bias[move] = 1.0
    layer = LinearLayer(np.zeros((9, 3), dtype=np.float32), bias)
    return Policy(
        PolicyNetwork((layer,), "tanh"),
        (3,),
        ActionSampling("softmax", 1.0),
        TaskSpec("turn"),
        steps,
        task_interface(TaskSpec("turn").resolve()),
    )


@pytest.fixture
def run(tmp_path: Path) -> TrainingRun:
    return create_run(tmp_path, RunConfig(TaskSpec("turn")))


def end(demonstration: Demonstration) -> None:
    while not demonstration.is_over:
        demonstration.step()


def test_without_a_policy_nobody_drives(run: TrainingRun) -> None:
    assert not Demonstration(run).begin_episode()


def test_cases_take_turns_and_one_can_be_chosen(run: TrainingRun) -> None:
    save_policy(always(FORWARD, 100), run.newest_policy)
    demonstration = Demonstration(run)
    seen = []
    for case in (None, None, "turn_b_to_a", "turn_b_to_a"):
        demonstration.case = case
        assert demonstration.begin_episode()
        first = demonstration.view()
        assert (first.step, first.outcome, first.trained) == (0, None, 100)
        end(demonstration)
        last = demonstration.view()
        assert last.case == first.case
        assert last.outcome is EpisodeOutcome.COLLIDED
        assert len(last.scene.trails[0]) > 1
        seen.append(last.case)
    assert seen == ["turn_a_to_b", "turn_b_to_a", "turn_b_to_a", "turn_b_to_a"]


def test_a_newer_policy_waits_for_the_end_of_the_episode(run: TrainingRun) -> None:
    save_policy(always(FORWARD, 100), run.newest_policy)
    demonstration = Demonstration(run)
    demonstration.begin_episode()
    demonstration.step()
    save_policy(always(LEFT, 2000), run.newest_policy)
    end(demonstration)
    assert demonstration.view().trained == 100
    demonstration.begin_episode()
    assert demonstration.view().trained == 2000
    end(demonstration)
    assert demonstration.view().outcome is EpisodeOutcome.TIMED_OUT


def test_once_all_is_over_the_best_one_drives(run: TrainingRun) -> None:
    save_policy(always(LEFT, 2000), run.newest_policy)
    demonstration = Demonstration(run)
    demonstration.begin_episode(kept=True)
    assert not demonstration.view().kept
    save_policy(always(FORWARD, 100), run.best_policy)
    demonstration.begin_episode(kept=True)
    assert demonstration.view().kept
    assert demonstration.view().trained == 100


def test_a_damaged_policy_says_so(run: TrainingRun) -> None:
    run.newest_policy.write_bytes(b"half")
    with pytest.raises(PolicyError, match=r"newest\.npz"):
        Demonstration(run).begin_episode()
