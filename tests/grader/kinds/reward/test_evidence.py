"""Trainings with a student's reward: their tests are for the picture alone."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from grader.kinds.reward.reward_training import TESTS, TestedTraining
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.evaluation import Evaluator
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.learner import Learner
from kit.learning.training.presets import find_preset
from kit.learning.training.training import make_learner
from kit.school.lessons.training_curves import read_training_curves


class Untested:
    def between_updates(self) -> None:
        pass

    def on_episode_end(self, episode: EpisodeStats) -> None:
        pass


def nearer(transition: Any) -> np.ndarray:
    """A reward that a student would write."""
    return np.asarray(transition.previous_to_go.sum(axis=-1) - transition.to_go.sum(axis=-1))


def new_learner(algorithm: str) -> Learner:
    found, choice = find_algorithm(algorithm), TaskSpec("turn")
    task = choice.resolve()
    return make_learner(found, find_preset("kit", found, task.preset), choice, task, seed=3, reward=nearer)


@pytest.mark.parametrize(
    ("algorithm", "steps"),
    [
        pytest.param("q-learning", 8_000, marks=pytest.mark.long),
        ("sarsa", 8_000),
        pytest.param("ppo", 12_000, marks=pytest.mark.long),
        pytest.param("dqn", 3_000, marks=pytest.mark.long),
    ],
)
def test_with_tests_or_without_the_same_seed_gives_the_same_policy(algorithm: str, steps: int) -> None:
    if find_algorithm(algorithm).needs_torch:
        pytest.importorskip("stable_baselines3")
    told: list[str] = []
    alone = new_learner(algorithm)
    alone.learn(steps, Untested())
    tested = new_learner(algorithm)  # only now: torch's random numbers begin anew with each
    progress = TrainingProgressReport(SubmissionClock(show_progress=told.append), 1, 1, steps)
    training = TestedTraining(tested, Evaluator(TaskSpec("turn").resolve()), steps, 3, progress)
    tested.learn(steps, training)
    training.test_last_steps()
    assert pickle.dumps(arrays_of(alone)) == pickle.dumps(arrays_of(tested))
    assert alone.steps == tested.steps
    curves = read_training_curves("".join(f"{line}\n" for line in told))
    assert curves is not None
    assert curves.drive is not None
    assert curves.drive.steps == tested.steps
    assert 2 <= len(curves.tests[0]) <= TESTS + 1


def arrays_of(learner: Learner) -> list[tuple[str, bytes]]:
    """Every number that the policy holds."""
    found: list[tuple[str, bytes]] = []

    def collect(name: str, value: Any) -> None:
        if isinstance(value, np.ndarray):
            found.append((name, value.tobytes()))
        elif isinstance(value, tuple | list):
            for number, each in enumerate(value):
                collect(f"{name}.{number}", each)
        elif hasattr(value, "__dataclass_fields__"):
            for field in value.__dataclass_fields__:
                collect(f"{name}.{field}", getattr(value, field))

    collect("policy", learner.policy())
    assert found
    return found
