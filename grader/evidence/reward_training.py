"""Trains with a student's reward within a budget of steps, and tests the policies by the true goal.

The trainer, its settings, the seeds and the test episodes are the grader's; the student's process only returns the reward
of each step.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from statistics import fmean

from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from grader.task_files import assignment_task
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.environment.rewards import RewardFunction
from kit.learning.policies.evaluation import Evaluator, derive_seed
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.learner import Learner
from kit.learning.training.optional_deps import require_learn_extra
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


class ClockCallbacks:
    """Training callbacks that show the progress, and end a training when the submission's time is used up."""

    def __init__(self, learner: Learner, progress: TrainingProgressReport) -> None:
        self._learner = learner
        self._progress = progress

    def between_updates(self) -> None:
        """Shows the progress. Raises StudentCodeError when the time is used up."""
        self._progress.clock.check()
        self._progress.show(self._learner.steps)

    def on_episode_end(self, episode: EpisodeStats) -> None:
        """Nothing is measured during the training."""


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
    shares = []
    for seed in range(budget.seeds):
        learner = make_learner(algorithm, preset, choice, task, seed=seed, reward=reward)
        progress = TrainingProgressReport(clock, seed + 1, budget.seeds, budget.steps)
        learner.learn(budget.steps, ClockCallbacks(learner, progress))
        progress.show_exam()
        shares.append(Evaluator(task).test(learner.policy(), budget.episodes, derive_seed(seed, "exam")).mean)
    return fmean(shares)
