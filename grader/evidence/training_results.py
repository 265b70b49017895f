"""Records of a student's trainings: what is trained, with which settings, and the results.

They stand apart from ``training``, which loads all that learning takes: settings that cannot be read need none of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import reduce
from typing import Final

from kit.learning.policies.confidence_intervals import lower_bound
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import LinearSchedule
from kit.learning.training.stopping_rules import NO_EPISODES, CaseCount, CaseCounts, success_rate

PICTURE_ROWS: Final = 16


class StopRule(Enum):
    """When a training stops."""

    NEVER = "never"
    FIRST = "first"
    """At the first test that goes well."""
    SURE = "sure"
    """When a longer test makes it sure."""


class CaseOrder(Enum):
    """How the cases follow one another."""

    MIXED = "mixed"
    APART = "apart"
    """First all training on the first case, then all on the next."""


@dataclass(frozen=True, slots=True)
class TrainingBudget:
    """What is to be learned, and how much training may cost."""

    choice: TaskSpec
    cases: tuple[str, ...]
    algorithms: tuple[str, ...]
    steps: int
    """The most steps of each training."""
    seeds: tuple[int, ...]
    secret_seeds: tuple[int, ...]
    """Used instead of ``seeds`` for the grade."""
    episodes: int
    """Episodes of each case in the final test of each training."""


@dataclass(frozen=True, slots=True)
class PosedTaskPlan:
    """What is done with a task that is handed in."""

    algorithm: str
    steps: int
    """Steps of each training."""
    trainings: int
    episodes: int
    """Episodes per case, in each test of a training and of a policy submitted with the task."""
    policy: str
    """Name of the file of such a policy; empty where none is asked for."""
    seed: int
    secret_seed: int | None
    enough: float = 1.0
    """The share that earns all points: once most trainings surely reach it, no further one is made, as the middle one counts."""


@dataclass(frozen=True, slots=True)
class TrainingSettings:
    """The settings that a student submits."""

    algorithm: str
    learning_rate: LinearSchedule
    exploration: LinearSchedule
    discount: float
    edges: tuple[float, ...]
    worlds: int
    train_on: tuple[str, ...]
    order: CaseOrder
    batch: int
    """Steps between two tests."""
    test_episodes: int
    """Episodes of each test, all cases together."""
    stop: StopRule
    goal: float
    keeps_best: bool
    steps: int
    """Most steps."""


@dataclass(frozen=True, slots=True)
class TrainingTest:
    """One test during a training."""

    steps: int
    counts: CaseCounts
    kept: bool
    """Whether its policy was the best so far."""


@dataclass(frozen=True, slots=True)
class TrainingResult:
    """The result of one training."""

    number: int
    steps: int
    tests: tuple[TrainingTest, ...]
    claimed: float
    """The success of the kept policy in its last test during the training; 0 if it was never tested."""
    exam: CaseCounts
    """Final test of the kept policy, on episodes that no other test uses."""
    is_stopped: bool
    """Whether a test ended it, before its last step."""

    @property
    def accuracy(self) -> float:
        return success_rate(self.exam)

    @property
    def sure_success(self) -> float:
        """The lower bound of the success in the exam, with 95 % confidence (Wilson)."""
        counts = self.exam.values()
        return lower_bound(sum(count.reached for count in counts), sum(count.episodes for count in counts))


@dataclass(frozen=True, slots=True)
class TrainingResults:
    """The results of all trainings."""

    budget: TrainingBudget
    settings: TrainingSettings
    trainings: tuple[TrainingResult, ...]

    def pooled_count(self, case: str) -> CaseCount:
        """Adds up a case's counts of all final tests."""
        counts = [training.exam[case] for training in self.trainings]
        return reduce(CaseCount.plus, counts, NO_EPISODES)

    def last_tests(self, case: str) -> CaseCount:
        """Adds up a case's counts of the last test of each training, which is of its newest policy."""
        counts = [training.tests[-1].counts[case] for training in self.trainings if training.tests]
        return reduce(CaseCount.plus, counts, NO_EPISODES)

    def success_lower_bound(self, *cases: str) -> float:
        """Returns the lower bound of the success in these cases together, with 95 % confidence (Wilson)."""
        counts = [self.pooled_count(case) for case in cases or self.budget.cases]
        return lower_bound(sum(count.reached for count in counts), sum(count.episodes for count in counts))

    @property
    def worst_case(self) -> str:
        return min(self.budget.cases, key=lambda case: self.pooled_count(case).share)

    def picture(self) -> str:
        """Draws the tests of the worst training, one per row."""
        worst = min(self.trainings, key=lambda training: training.accuracy)
        cases = self.budget.cases
        rows = [f"training {worst.number}:  steps  " + "  ".join(f"{case:>12}" for case in cases)]
        skipped = max(0, len(worst.tests) - PICTURE_ROWS)
        for test in worst.tests[skipped:]:
            bars = "  ".join(
                f"{_share_bar(test.counts[case].share)} {test.counts[case].share:4.2f}" for case in cases
            )
            rows.append(f"{test.steps:18,}  {bars}{'  best so far' if test.kept else ''}")
        bars = "  ".join(
            f"{_share_bar(worst.exam[case].share)} {worst.exam[case].share:4.2f}" for case in cases
        )
        return "\n".join([*rows, f"{'exam':>18}  {bars}"])


def _share_bar(share: float) -> str:
    return f"{'#' * round(7 * share):7}"
