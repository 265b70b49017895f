"""Tracks the status of a training run event by event: curves, outcomes, cases, rewards, remaining time.

Whoever shows a run reads each event once, however long the run is.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.training.events import (
    Evaluated,
    TrainingEnded,
    TrainingEvent,
    TrainingNote,
    TrainingProgress,
    TrainingStarted,
)
from kit.learning.training.measures import MEASURES
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_text import format_event, success_shares
from kit.learning.training.training import resolve_preset
from kit.learning.training.training_summary import TrainingCommand, TrainingSummary, summarise_events

RECENT_REPORTS = 10
"""Batches of training, about five seconds: the present figures are taken over this many."""

ADJACENCY = "side by side"
"""The metric of two robots: share of steps in which they are next to each other."""

OutcomeCounts: TypeAlias = tuple[int, ...]
"""How many episodes ended in each ``EpisodeOutcome``, in its order."""


@dataclass(frozen=True, slots=True)
class RunPlan:
    """The task of a run and its limits."""

    title: str
    cases: tuple[str, ...]
    steps: int
    """Most steps."""
    goal: float | None
    """The success at which it stops; None if it goes to its last step."""
    greedy: bool
    """Whether its tests play the best action, not one by chance."""


@dataclass(frozen=True, slots=True, eq=False)
class TrainingCurve:
    """The training curve: one row for each batch of episodes."""

    steps: FloatArray
    """(n,), rising."""
    outcomes: IntArray
    """(n, 3) episodes, in the order of ``EpisodeOutcome``."""
    reward: FloatArray
    """(n,) mean sum over an episode."""
    metrics: dict[str, FloatArray]
    """(n,) each, NaN where a batch does not tell it: ``side by side`` of two robots, every term of the reward, and the
    learner's measures."""


@dataclass(frozen=True, slots=True, eq=False)
class Evaluations:
    """The results of the evaluations: one row for each."""

    steps: FloatArray
    """(n,), rising."""
    mean: FloatArray
    """(n,) share of episodes that reached the target, mean over the cases."""
    worst: FloatArray
    """(n,) of the worst case."""


@dataclass(frozen=True, slots=True)
class CaseStatus:
    """One case: a map and a direction."""

    name: str
    trained: OutcomeCounts
    """Recent outcomes in training."""
    last_evaluation: OutcomeCounts
    """Outcomes of the last test; all 0 before the first."""


@dataclass(frozen=True, slots=True, eq=False)
class RunStatus:
    """The status of a run at one moment."""

    plan: RunPlan
    summary: TrainingSummary
    batches: TrainingCurve
    evaluations: Evaluations
    cases: tuple[CaseStatus, ...]
    rate: float
    """Steps a second in training, recently."""
    remaining_s: float | None
    """Time to the last step, tests included; None if unknown. Training may reach its goal earlier."""
    reward: float | None
    """Mean sum over an episode, recently; likewise below."""
    length: float | None
    """Steps."""
    adjacency: float | None
    """Mean share of steps in which two robots are side by side."""
    terms: dict[str, float]
    """The reward by named term."""
    measures: dict[str, float]
    """What the learner last measured of its own learning; see ``kit.learning.training.measures``."""
    note: str
    """The last event in words, progress left out."""


def plan_of_run(config: RunConfig) -> RunPlan:
    """UnknownTask or UnknownAlgorithm if the run is of a kit that knew others."""
    preset = resolve_preset(config)
    strategy = preset.stopping_rule
    goal: float | None = getattr(strategy, "goal", None)
    # In the order in which they may be cut off where room is short.
    words = [config.choice.title, config.algorithm, f"seed {config.seed}", config.preset_text]
    return RunPlan(
        ", ".join(words),
        tuple(case.name for _, case in config.choice.resolve().map_cases()),
        preset.steps,
        None if config.keep_training else goal,
        strategy.greedy,
    )


class RunTracker:
    """Folds a run's events into its present status."""

    def __init__(self, plan: RunPlan) -> None:
        self._plan = plan
        self._last: dict[tuple[type[TrainingEvent], bool], TrainingEvent] = {}
        """The last of every kind, the newest last: what a summary needs."""
        self._batches: list[tuple[int, OutcomeCounts, float]] = []
        self._metrics: list[dict[str, float]] = []
        self._evaluations: list[tuple[int, float, float]] = []
        self._recent: deque[TrainingProgress] = deque(maxlen=RECENT_REPORTS)
        self._tested: dict[str, OutcomeCounts] = {}
        self._note = ""
        self._is_note_over = False
        """Whether the next progress ends it."""

    def add(self, event: TrainingEvent) -> None:
        """Takes the next event."""
        kind = type(event), isinstance(event, Evaluated) and event.kept
        self._last.pop(kind, None)
        self._last[kind] = event
        match event:
            case TrainingStarted():
                self._truncate_after(event.steps)
            case TrainingProgress():
                self._recent.append(event)
                outcomes = _sum_counts(event.episodes.values())
                if event.reward is not None:
                    self._batches.append((event.steps, outcomes, event.reward))
                    beside = {ADJACENCY: event.adjacency} if event.adjacency else {}  # of one robot it is 0
                    told = {
                        MEASURES[name].title: number
                        for name, number in event.measures.items()
                        if name in MEASURES
                    }
                    self._metrics.append({**beside, **event.terms, **told})
            case Evaluated():
                shares = list(success_shares(event).values())
                self._evaluations.append((event.steps, sum(shares) / len(shares), min(shares)))
                self._tested = {case: tuple(counts) for case, counts in event.cases.items()}
            case _:
                pass
        if not isinstance(event, TrainingProgress):
            self._note = _event_note(event)
        elif self._is_note_over:
            self._note = ""
        self._is_note_over = isinstance(event, TrainingNote) and event.until_progress

    def status(self, *, alive: bool, order: TrainingCommand) -> RunStatus:
        """Returns the status of the run, given whether a process trains it and which command it was sent."""
        summary = summarise_events(tuple(self._last.values()), alive=alive, order=order)
        return RunStatus(
            plan=self._plan,
            summary=summary,
            batches=self._training_curve(),
            evaluations=Evaluations(*np.array(self._evaluations, dtype=np.float64).reshape(-1, 3).T),
            cases=tuple(
                CaseStatus(
                    name,
                    _sum_counts(each.episodes[name] for each in self._recent if name in each.episodes),
                    self._tested.get(name, _sum_counts(())),
                )
                for name in self._plan.cases
            ),
            rate=_weighted_mean([(1, each.rate) for each in self._recent]) or 0.0,
            remaining_s=self._remaining_seconds() if summary.state in ("running", "paused") else None,
            reward=self._recent_mean("reward"),
            length=self._recent_mean("length"),
            adjacency=self._recent_mean("adjacency"),
            terms=self._terms(),
            measures=summary.measures,
            note=self._note,
        )

    def _truncate_after(self, steps: int) -> None:
        """A killed run goes on from its last checkpoint: what came after that is not part of it any more."""
        self._batches = [each for each in self._batches if each[0] <= steps]
        del self._metrics[len(self._batches) :]
        self._evaluations = [each for each in self._evaluations if each[0] <= steps]
        self._recent.clear()

    def _training_curve(self) -> TrainingCurve:
        steps = np.array([steps for steps, _, _ in self._batches], dtype=np.float64)
        outcomes = np.array([counts for _, counts, _ in self._batches], dtype=np.int64)
        reward = np.array([reward for _, _, reward in self._batches], dtype=np.float64)
        names = dict.fromkeys(name for each in self._metrics for name in each)
        metrics = {
            name: np.array([each.get(name, np.nan) for each in self._metrics], dtype=np.float64)
            for name in names
        }
        return TrainingCurve(steps, outcomes.reshape(-1, len(EpisodeOutcome)), reward, metrics)

    def _remaining_seconds(self) -> float | None:
        if len(self._recent) < 2:
            return None
        first, last = self._recent[0], self._recent[-1]
        gone = last.seconds - first.seconds
        if gone <= 0 or last.steps <= first.steps:
            return None
        return max(0, self._plan.steps - last.steps) * gone / (last.steps - first.steps)

    def _recent_mean(self, name: str) -> float | None:
        values = ((_episode_count(each), getattr(each, name)) for each in self._recent)
        return _weighted_mean([(count, value) for count, value in values if value is not None])

    def _terms(self) -> dict[str, float]:
        names = dict.fromkeys(name for each in self._recent for name in each.terms)
        means = {
            name: _weighted_mean(
                [(_episode_count(each), each.terms[name]) for each in self._recent if name in each.terms]
            )
            for name in names
        }
        return {name: mean for name, mean in means.items() if mean is not None}


def _event_note(event: TrainingEvent) -> str:
    """Formats an event in one line, without steps and seconds."""
    if isinstance(event, TrainingEnded):
        return f"{event.how}: {event.reason}"
    if isinstance(event, Evaluated):
        line = format_event(event)
        return line[line.index("TEST") :]
    return format_event(event)


def _episode_count(progress: TrainingProgress) -> int:
    return sum(map(sum, progress.episodes.values()))


def _sum_counts(counts: Iterable[Sequence[int]]) -> OutcomeCounts:
    total = [0] * len(EpisodeOutcome)
    for each in counts:
        total = [one + other for one, other in zip(total, each, strict=True)]
    return tuple(total)


def _weighted_mean(weighed: list[tuple[int, float]]) -> float | None:
    weight = sum(count for count, _ in weighed)
    return sum(count * value for count, value in weighed) / weight if weight else None
