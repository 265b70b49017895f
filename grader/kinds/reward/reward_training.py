"""Trains with a reward, and tests what is learned."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from statistics import fmean
from typing import Final

from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from grader.task_files import assignment_task
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.episode_paths import PathRecorder
from kit.learning.policies.evaluation import Evaluator
from kit.learning.policies.paths_picture import worst_drive
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.reward import RewardFunction
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.learn_extra import require_learn_extra
from kit.learning.training.learner import Learner
from kit.learning.training.presets import find_preset
from kit.learning.training.training import make_learner


@dataclass(frozen=True, slots=True)
class RewardTrainingParams:
    """How to train, and how often."""

    task: str = "turn"
    """A task of the kit's, or a task file in the assignment's folder."""
    algorithm: str = "q-learning"
    """``q-learning`` and ``sarsa`` need no extra package; the others want the extra ``learn``."""
    steps: int = 50_000
    seeds: int = 3
    """Number of trainings, each from the start; a single one may be lucky."""
    episodes: int = 100
    """Test episodes after each training, for each case of the task."""


TESTS: Final = 8
"""During a training, for its curve and the newest drive. They decide nothing."""

TEST_EPISODES: Final = 20
"""Episodes per case in one test."""


class TestedTraining:
    """Training callbacks that test the newest policy now and then and show how it went, and end a training when the
    submission's time is used up.

    A test takes nothing from the training: it has worlds, a reward and random numbers of its own.
    """

    __test__ = False  # no test class for pytest

    def __init__(
        self, learner: Learner, evaluator: Evaluator, steps: int, seed: int, progress: TrainingProgressReport
    ) -> None:
        """``steps``: of the whole training. ``seed``: the training's."""
        self._learner = learner
        self._evaluator = evaluator
        self._every = max(1, steps // TESTS)
        self._seed = seed
        self._progress = progress
        self._count = self._tested_steps = 0

    def between_updates(self) -> None:
        """Shows the progress. Raises StudentCodeError when the time is used up."""
        self._progress.clock.check()
        self._progress.show(self._learner.steps)
        if self._learner.steps >= (self._count + 1) * self._every:
            self._test()

    def on_episode_end(self, episode: EpisodeStats) -> None:
        """No-op: tests count, not episodes of training."""

    def test_last_steps(self) -> None:
        """Tests the policy at the end, if the last steps have not been tested."""
        if self._tested_steps < self._learner.steps:
            self._test()

    def _test(self) -> None:
        self._tested_steps = self._learner.steps
        self._count = self._learner.steps // self._every
        recorder, seed = PathRecorder(), derive_seed(self._seed, "test", self._count)
        result = self._evaluator.test(self._learner.policy(), TEST_EPISODES, seed, paths=recorder)
        drive = worst_drive(self._evaluator.task, result, recorder)
        self._progress.add_test(self._learner.steps, result.mean, drive)


def mean_success(
    reward: RewardFunction, budget: RewardTrainingParams, clock: SubmissionClock, folder: Path
) -> float:
    """Returns the share of episodes that reach the target after training with ``reward``, the mean over all seeds.

    ``folder``: the assignment's, which may hold the task's file. Raises StudentCodeError where the student's code fails or
    the submission's time is used up, and LookupError or LearnExtraMissing where the assignment asks for something that is
    not here.
    """
    algorithm, choice = find_algorithm(budget.algorithm), assignment_task(budget.task, folder)
    if algorithm.needs_torch:
        require_learn_extra()
    task = choice.resolve()
    preset = find_preset("kit", algorithm, task.preset)
    evaluator = Evaluator(task)
    shares = []
    for seed in range(budget.seeds):
        learner = make_learner(algorithm, preset, choice, task, seed=seed, reward=reward)
        progress = TrainingProgressReport(clock, seed + 1, budget.seeds, budget.steps)
        training = TestedTraining(learner, evaluator, budget.steps, seed, progress)
        learner.learn(budget.steps, training)
        training.test_last_steps()
        progress.show_exam()
        shares.append(evaluator.test(learner.policy(), budget.episodes, derive_seed(seed, "exam")).mean)
        progress.add_exam(shares[-1])
    return fmean(shares)
