"""Trains with a student's settings and several seeds, and tests the policy that each training keeps.

No program of the student's runs. The task, its reward, the budget and the final test are the assignment's.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from grader.evidence.training_results import (
    CaseOrder,
    StopRule,
    TrainingBudget,
    TrainingResult,
    TrainingResults,
    TrainingSettings,
    TrainingTest,
)
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.episode_paths import PathRecorder
from kit.learning.policies.evaluation import EvaluationResult, Evaluator
from kit.learning.policies.paths_picture import worst_drive
from kit.learning.policies.policy import Policy
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.training.algorithm_settings import TabularParams
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.learn_extra import require_learn_extra
from kit.learning.training.learner import Learner, StopLearning
from kit.learning.training.presets import Preset, find_preset
from kit.learning.training.stopping_rules import (
    CaseCount,
    CaseCounts,
    StoppingMemory,
    StoppingRule,
    TrainUntilGoal,
    TrainUntilSure,
    success_rate,
)
from kit.learning.training.training import make_learner
from kit.render.drive_playback import DrivePlayback

UNREACHABLE_GOAL: Final = 2.0
"""The goal of trainings that no test is to stop."""
CONFIRMING_EPISODES: Final = 200
"""Episodes of each case in the longer test of ``StopRule.SURE``."""


def run_trainings(
    settings: TrainingSettings,
    budget: TrainingBudget,
    seeds: tuple[int, ...],
    clock: SubmissionClock | None = None,
    enough: float = 1.0,
) -> TrainingResults:
    """Trains once for each seed, until most of them surely succeed in the share ``enough`` of their exams. Raises LearnExtraMissing, and StudentCodeError when the submission's time is used up."""
    clock = clock or SubmissionClock()
    if find_algorithm(settings.algorithm).needs_torch:
        require_learn_extra()
    trainings = []
    for number, seed in enumerate(seeds, 1):
        progress = TrainingProgressReport(clock, number, len(seeds), settings.steps)
        trainings.append(_run_training(settings, budget, seed, progress))
        if sum(each.sure_success >= enough for each in trainings) > len(seeds) / 2:
            break
    return TrainingResults(budget, settings, tuple(trainings))


def _run_training(
    settings: TrainingSettings, budget: TrainingBudget, seed: int, progress: TrainingProgressReport
) -> TrainingResult:
    monitor = _TrainingMonitor(settings, budget, seed, progress)
    stages = (
        [settings.train_on] if settings.order is CaseOrder.MIXED else [(case,) for case in settings.train_on]
    )
    learner: Learner | None = None
    is_stopped = False
    for stage, on in enumerate(stages, 1):
        learner = _make_learner(settings, budget, on, derive_seed(seed, "training", stage), learner)
        monitor.learner = learner
        try:
            learner.learn(settings.steps * stage // len(stages), monitor)
        except StopLearning:
            is_stopped = True
            break
    assert learner is not None  # a plan names at least one case
    monitor.test_last_steps()
    policy = monitor.best if settings.keeps_best and monitor.best is not None else learner.policy()
    claimed = monitor.best_accuracy if settings.keeps_best else monitor.last_accuracy
    progress.show_exam()
    exam = monitor.examine(policy, budget.episodes, derive_seed(seed, "exam"))
    result = TrainingResult(progress.number, learner.steps, tuple(monitor.tests), claimed, exam, is_stopped)
    progress.add_exam(result.accuracy)
    return result


def _make_learner(
    settings: TrainingSettings, budget: TrainingBudget, on: tuple[str, ...], seed: int, before: Learner | None
) -> Learner:
    """Makes a learner of these cases that continues from the one before."""
    algorithm = find_algorithm(settings.algorithm)
    choice = replace(budget.choice, on=on)
    task = budget.choice.resolve()
    is_continuous = not isinstance(task.actions, DiscreteActions)
    preset = find_preset("kit", algorithm, task.preset, is_continuous=is_continuous)
    learner = make_learner(
        algorithm, _adapt_preset(preset, settings, algorithm.needs_torch), choice, choice.resolve(), seed=seed
    )
    if before is not None:
        learner.load(before.save())
    return learner


def _adapt_preset(preset: Preset, settings: TrainingSettings, neural: bool) -> Preset:
    if neural:
        return replace(
            preset, worlds=settings.worlds, learning_rate=settings.learning_rate, steps=settings.steps
        )
    tabular = TabularParams(settings.learning_rate, settings.discount, settings.exploration, settings.edges)
    return replace(preset, settings=tabular, worlds=settings.worlds, steps=settings.steps)


def _make_stopping_rule(settings: TrainingSettings, cases: int) -> StoppingRule:
    if settings.stop is StopRule.SURE:
        screening = -(-settings.test_episodes // cases)
        confirming = max(CONFIRMING_EPISODES, screening)
        return TrainUntilSure(
            test_interval=settings.batch,
            goal=settings.goal,
            screening_episodes=screening,
            confirming_episodes=confirming,
            patience=0,
        )
    goal = settings.goal if settings.stop is StopRule.FIRST else UNREACHABLE_GOAL
    return TrainUntilGoal(settings.batch, settings.test_episodes, goal)


class _TrainingMonitor:
    """Tests the learner now and then, keeps the best policy, and stops as planned."""

    learner: Learner

    def __init__(
        self, settings: TrainingSettings, budget: TrainingBudget, seed: int, progress: TrainingProgressReport
    ) -> None:
        self._clock = progress.clock
        self._progress = progress
        self._evaluator = Evaluator(budget.choice.resolve())
        self._strategy = _make_stopping_rule(settings, len(budget.cases))
        self._every, self._seed = settings.batch, seed
        self._next, self._test_count = settings.batch, 0
        self._memory = StoppingMemory()
        self._newest_drive: DrivePlayback | None = None
        """Drive of the newest test: the first one of its worst case."""
        self.tests: list[TrainingTest] = []
        self.best: Policy | None = None
        self.best_accuracy = self.last_accuracy = 0.0

    @property
    def cases(self) -> int:
        return len(self._evaluator.cases)

    def between_updates(self) -> None:
        self._clock.check()
        self._progress.show(self.learner.steps)
        if self.learner.steps >= self._next:
            self._next = self.learner.steps + self._every
            self._run_test()

    def on_episode_end(self, episode: EpisodeStats) -> None:
        """No-op: tests count, not episodes of training."""

    def test_last_steps(self) -> None:
        """Tests the policy at the end, if the last steps have not been tested."""
        if not self.tests or self.tests[-1].steps < self.learner.steps:
            try:
                self._run_test()
            except StopLearning:
                return

    def __call__(self, episodes: int) -> CaseCounts:
        """Tests the present policy."""
        self._test_count += 1
        seed = derive_seed(self._seed, "test", self._test_count)
        recorder = PathRecorder()
        result = self._test_policy(self.learner.policy(), -(-episodes // self.cases), seed, recorder)
        self._newest_drive = worst_drive(self._evaluator.task, result, recorder)
        return _case_counts(result)

    def examine(self, policy: Policy, episodes: int, seed: int) -> CaseCounts:
        """Tests a policy; ``episodes`` is the number for each case. Raises StudentCodeError when the time is used up."""
        return _case_counts(self._test_policy(policy, episodes, seed))

    def _test_policy(
        self, policy: Policy, episodes: int, seed: int, recorder: PathRecorder | None = None
    ) -> EvaluationResult:
        self._clock.check()
        return self._evaluator.test(policy, episodes, seed, paths=recorder)

    def _run_test(self) -> None:
        decision = self._strategy.evaluate(self.learner.steps, self._memory, self)
        self._memory = decision.memory
        self.tests.append(TrainingTest(self.learner.steps, decision.counts, decision.is_best))
        self.last_accuracy = success_rate(decision.counts)
        self._progress.add_test(self.learner.steps, self.last_accuracy, self._newest_drive)
        if decision.is_best:
            self.best, self.best_accuracy = self.learner.policy(), self.last_accuracy
        if decision.stop:
            raise StopLearning(decision.reason)


def _case_counts(result: EvaluationResult) -> CaseCounts:
    return {case.case: CaseCount(case.reached, case.episodes) for case in result.cases}
