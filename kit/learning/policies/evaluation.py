"""Evaluates policies: success by case, on episodes of their own, with confidence intervals."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.document.html import table_to_html
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStats, EpisodeStatsRecorder
from kit.learning.policies.confidence_intervals import ConfidenceInterval, wilson_interval
from kit.learning.policies.episode_paths import PathRecorder
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.policy_file import load_policy
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.reward import RewardFunction
from kit.learning.tasks.student_reward import StudentReward, metric_parameters
from kit.learning.tasks.task_case import TaskCase

PARALLEL_WORLDS = 1024
"""About this many worlds side by side: more is not faster."""


class EpisodeShare(NamedTuple):
    """A share of an episode's steps, over several episodes."""

    mean: float
    """NaN of no episode."""
    sd: float
    """Sample standard deviation over the episodes; NaN of fewer than two."""

    @classmethod
    def of(cls, shares: Sequence[float]) -> EpisodeShare:
        """
        >>> EpisodeShare.of([0.5, 0.7]).mean
        0.6
        """
        sd = float(np.std(shares, ddof=1)) if len(shares) > 1 else np.nan
        return cls(sum(shares) / len(shares) if shares else np.nan, sd)


NO_SHARE: Final = EpisodeShare.of(())


@dataclass(frozen=True, slots=True)
class CaseResult:
    """Results of one case's episodes."""

    case: str
    group: str
    outcomes: tuple[int, int, int]
    """How many ended in each ``EpisodeOutcome``."""
    steps: float
    """Mean length of those that reached the target; NaN where none has."""
    reward: float
    """Mean sum over an episode."""
    adjacency: float
    """Mean share of an episode's steps that two robots were side by side, as rays tell; NaN for one robot."""
    adjacency_sd: float = np.nan
    """Sample standard deviation of that share over the episodes; NaN for one robot or one episode."""
    reached_by_rays: EpisodeShare = NO_SHARE
    """The share by rays of the episodes that reached the target alone: others may end side by side because they began so."""
    reached_by_poses: EpisodeShare = NO_SHARE
    """The same as poses tell."""
    metrics: Mapping[str, float] = field(default_factory=dict)
    """Mean sum over an episode of each metric of the task's own reward file, by name."""

    @property
    def episodes(self) -> int:
        return sum(self.outcomes)

    @property
    def reached(self) -> int:
        return self.outcomes[0]

    @property
    def share(self) -> float:
        return self.reached / self.episodes

    @property
    def interval(self) -> ConfidenceInterval:
        """The 95 % confidence interval of the share."""
        return wilson_interval(self.reached, self.episodes)


def _case_cells(case: CaseResult) -> tuple[Cell, ...]:
    _, collided, timed_out = (count / case.episodes for count in case.outcomes)
    beside = (case.reached_by_rays.mean, case.reached_by_poses.mean)
    return (case.case, case.share, case.interval, collided, timed_out, case.steps, *beside)


def _mean(numbers: Iterable[float]) -> float:
    return float(np.mean(list(numbers)))


@dataclass(frozen=True, slots=True, repr=False)
class EvaluationResult:
    """Results of an evaluation on all cases."""

    task: str
    greedy: bool
    cases: tuple[CaseResult, ...]

    def __repr__(self) -> str:
        """``EvaluationResult(turn: success 0.985, worst 0.970 in turn_b_to_a)``"""
        worst = self.worst
        return f"{type(self).__name__}({self.task}: success {self.mean:.3f}, worst {worst.share:.3f} in {worst.case})"

    def _repr_html_(self) -> str:
        """The table, which a notebook shows."""
        return table_to_html(self.table())

    @property
    def mean(self) -> float:
        """Mean of the cases' shares."""
        return float(np.mean([case.share for case in self.cases]))

    @property
    def worst(self) -> CaseResult:
        """The case that goes worst: a mean hides it."""
        return min(self.cases, key=lambda case: case.share)

    @property
    def reward(self) -> float:
        """Mean sum over an episode, of all cases."""
        return float(np.mean([case.reward for case in self.cases]))

    @property
    def is_pair(self) -> bool:
        """Whether two robots drove."""
        return not np.isnan(self.cases[0].adjacency)

    @property
    def metrics(self) -> dict[str, float]:
        """Mean sum over an episode of each metric of the task's own reward file, of all cases."""
        return {name: _mean(case.metrics[name] for case in self.cases) for name in self.cases[0].metrics}

    def groups(self) -> dict[str, float]:
        """Mean share by group of cases; those without one are left out."""
        names = dict.fromkeys(case.group for case in self.cases if case.group)
        return {
            name: float(np.mean([case.share for case in self.cases if case.group == name])) for name in names
        }

    def table(self) -> Table:
        """A row for each case, then the mean; below it the worst case."""
        columns = [
            Column("case", CellStyle.TEXT),
            Column("success", decimals=3),
            Column("95 % interval", decimals=3),
            Column("collided", decimals=3),
            Column("timed out", decimals=3),
            Column("steps", decimals=0),
        ]
        if self.is_pair:
            columns += [Column("by rays"), Column("by pose")]
        count = len(columns)
        own = self.metrics
        columns += [Column(name, decimals=2) for name in own]
        rows = [(*_case_cells(case)[:count], *case.metrics.values()) for case in self.cases]
        rows.append(("mean", self.mean, *[""] * (count - 2), *own.values()))
        worst = self.worst
        note = (
            f"worst: {worst.share:.3f} in {worst.case}; {worst.episodes} episodes each, {self.action_choice}"
        )
        if self.is_pair:
            note += "; by rays, by pose: share of steps side by side, of episodes that reached the target"
        return Table("test", "", tuple(columns), tuple(rows), note, is_ruled=False)

    @property
    def action_choice(self) -> str:
        return "greedy" if self.greedy else "sampled"

    def as_dict(self) -> dict[str, Any]:
        """JSON-able; NaN as None."""
        return {
            "task": self.task,
            "greedy": self.greedy,
            "mean": self.mean,
            "worst": self.worst.share,
            "worst_case": self.worst.case,
            "groups": self.groups(),
            "metrics": self.metrics,
            "cases": {
                case.case: {
                    **dict(zip(("reached", "collided", "timed_out"), case.outcomes, strict=True)),
                    "share": case.share,
                    "interval": list(case.interval),
                    "steps": _number_or_none(case.steps),
                    "reward": case.reward,
                    "metrics": dict(case.metrics),
                    "adjacency": _number_or_none(case.adjacency),
                    "reached_by_rays": _number_or_none(case.reached_by_rays.mean),
                    "reached_by_poses": _number_or_none(case.reached_by_poses.mean),
                }
                for case in self.cases
            },
        }


def _number_or_none(number: float) -> float | None:
    """JSON has no NaN."""
    return None if np.isnan(number) else number


class Evaluator:
    """Evaluates policies on a task. Keeps its worlds from one evaluation to the next."""

    def __init__(
        self, task: LearningTask, reward: RewardFunction | None = None, *, counts_metrics: bool = False
    ) -> None:
        """``counts_metrics``: whether the metrics of ``reward`` are told too, that of the task's own file."""
        self.task = task
        self._reward_function = reward
        self._counts_metrics = counts_metrics
        self._cases = tuple(case for _, case in task.map_cases())
        self._batches: dict[int, BatchEnv] = {}

    @property
    def cases(self) -> tuple[str, ...]:
        return tuple(case.name for case in self._cases)

    def test(
        self,
        policy: Policy,
        episodes: int,
        seed: int,
        *,
        greedy: bool = True,
        before_step: Callable[[], None] = lambda: None,
        paths: PathRecorder | None = None,
    ) -> EvaluationResult:
        """Evaluates a policy on at least ``episodes`` episodes of each case, whose randomness comes from ``seed``.

        Every world drives the same number of episodes, so short ones do not count more often than long ones.
        ``before_step``: called before each step of all worlds; what it raises ends the evaluation.
        ``paths``: records the ways of some of the episodes.
        Raises PolicyError if the policy does not fit the task.
        """
        policy.check_fits(self.task)
        rounds = -(-episodes * len(self._cases) // PARALLEL_WORLDS)
        n = len(self._cases) * -(-episodes // rounds)
        batch = self._batch(n)
        player = policy.make_player(n, None if greedy else np.random.default_rng(derive_seed(seed, "moves")))
        left, sums = np.full(n, rounds), {case.name: _CaseSums() for case in self._cases}
        observations, fresh, recorder = (
            batch.reset(seed=seed),
            np.ones(n, dtype=np.bool_),
            EpisodeStatsRecorder(batch, with_poses=True),
        )
        if paths is not None:
            paths.begin(batch)
        with threadpool_limits(1, user_api="blas"):
            while left.any():
                before_step()
                step = batch.step(player.act(observations, fresh))
                if paths is not None:
                    paths.add(step)
                for episode in recorder.add(step):
                    if left[episode.world]:
                        left[episode.world] -= 1
                        sums[episode.case].add(episode)
                        if self._counts_metrics:
                            sums[episode.case].add_metrics(episode.terms)
                observations, fresh = step.observations, step.ended
        pair = self.task.robots > 1
        return EvaluationResult(
            self.task.name, greedy, tuple(sums[case.name].result(case, pair) for case in self._cases)
        )

    def _batch(self, n: int) -> BatchEnv:
        if n not in self._batches:
            self._batches[n] = BatchEnv(self.task, n, reward=self._reward_function)
        return self._batches[n]


@dataclass(slots=True)
class _CaseSums:
    """Sums over the episodes of one case."""

    outcomes: dict[EpisodeOutcome, int] = field(default_factory=lambda: dict.fromkeys(EpisodeOutcome, 0))
    steps: int = 0
    """Steps of the episodes that reached the target."""
    reward: float = 0.0
    adjacency: list[float] = field(default_factory=list)
    metrics: dict[str, float] = field(default_factory=dict)
    reached: list[tuple[float, float]] = field(default_factory=list)
    """By rays and by poses, of the episodes that reached the target."""

    def add(self, episode: EpisodeStats) -> None:
        self.outcomes[episode.outcome] += 1
        self.steps += episode.steps if episode.outcome is EpisodeOutcome.REACHED else 0
        self.reward += episode.reward
        self.adjacency.append(episode.adjacency)
        if episode.outcome is EpisodeOutcome.REACHED:
            self.reached.append((episode.adjacency, episode.by_poses))

    def add_metrics(self, metrics: Mapping[str, float]) -> None:
        for name, value in metrics.items():
            self.metrics[name] = self.metrics.get(name, 0.0) + value

    def result(self, case: TaskCase, pair: bool) -> CaseResult:
        reached, collided, timed_out = self.outcomes.values()
        episodes = reached + collided + timed_out
        told = [EpisodeShare.of([each[k] for each in self.reached if pair]) for k in range(2)]
        return CaseResult(
            case.name,
            case.group,
            (reached, collided, timed_out),
            steps=self.steps / reached if reached else np.nan,
            reward=self.reward / episodes,
            adjacency=sum(self.adjacency) / episodes if pair else np.nan,
            adjacency_sd=float(np.std(self.adjacency, ddof=1)) if pair and episodes > 1 else np.nan,
            reached_by_rays=told[0],
            reached_by_poses=told[1],
            metrics={name: total / episodes for name, total in self.metrics.items()},
        )


def evaluate_on(
    task: LearningTask, policy: Policy, episodes: int, seed: int, *, greedy: bool = True
) -> EvaluationResult:
    """Tests a policy as ``Evaluator`` does; where the task's own reward file has metrics, with these.

    Raises PolicyError, RewardFileError, and StudentCodeError where the file's code fails.
    """
    file = task.reward_file
    if file is None or not metric_parameters(file):
        return Evaluator(task).test(policy, episodes, seed, greedy=greedy)
    with StudentReward(file) as reward:
        return Evaluator(task, reward, counts_metrics=True).test(policy, episodes, seed, greedy=greedy)


def evaluate_policy(
    policy: Policy | Path | str,
    *,
    task: LearningTask | Path | str | None = None,
    episodes: int = 100,
    seed: int = 0,
    greedy: bool = True,
) -> EvaluationResult:
    """Tests a policy on at least ``episodes`` episodes of each case and returns its success rate by case.

    ``policy``: a policy or its file. ``task``: one, its name or its file; default: the one that it was trained on. ``greedy``:
    whether it takes its best action, or draws actions as it did in training. The same arguments give the same result.

    Raises PolicyError if the file is damaged or the policy does not fit the task, UnknownTask, and ValueError for fewer than one
    episode.

    >>> result = kit.evaluate_policy("best.npz", episodes=10)
    >>> [case.case for case in result.cases]
    ['turn_a_to_b', 'turn_b_to_a']
    >>> 0.0 <= result.worst.share <= result.mean <= 1.0
    True
    """
    if not isinstance(policy, (Policy, str, Path)):
        raise PolicyError(
            f"a {type(policy).__name__} is not a policy of the kit's: kit.export_policy(model, task) makes one of it."
        )
    if episodes < 1:
        raise ValueError(f"there must be at least one episode of each case, not {episodes}")
    policy = policy if isinstance(policy, Policy) else load_policy(policy)
    if task is None:
        task = policy.trained_on.resolve()
    elif not isinstance(task, LearningTask):
        task = find_task(str(task))
    return evaluate_on(task, policy, episodes, seed, greedy=greedy)
