"""Collects evidence from episodes: which ones a criterion needs, how they are labelled, and each run only once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from grader.assignment import MAX_COUNTERPARTS, Assignment, Criterion, SeedSet, Trial, counterpart_seed
from grader.evidence.contract import Evidence, EvidenceOptions, EvidenceRecord
from grader.evidence.submission_clock import SubmissionClock


@dataclass(frozen=True, slots=True)
class EpisodeSpec:
    """One episode to run."""

    trial: Trial
    seed: int
    label: str
    """Names it without giving a secret away: ``maze, secret seed 2``."""
    secret: bool


def episode_specs(assignment: Assignment, criterion: Criterion, *, secret: bool) -> Iterator[EpisodeSpec]:
    """Yields the episodes of a criterion, trial by trial; those with secret seeds only if ``secret`` is True."""
    for name in criterion.trials:
        trial = assignment.trial(name)
        if criterion.seeds is not SeedSet.SECRET:
            for seed in trial.seeds:
                yield EpisodeSpec(trial, seed, f"{name}, seed {seed}", secret=False)
        if criterion.seeds is not SeedSet.PUBLIC and secret:
            for number, seed in enumerate(trial.secret_seeds, 1):
                yield EpisodeSpec(trial, seed, f"{name}, secret seed {number}", secret=True)


def counterpart_specs(assignment: Assignment, criterion: Criterion) -> Iterator[EpisodeSpec]:
    """Yields public episodes of a criterion's trials that its assignment does not hold, alternating between trials."""
    trials = [trial for trial in map(assignment.trial, criterion.trials) if trial.secret_seeds]
    for number in range(MAX_COUNTERPARTS if trials else 0):
        trial, seed = trials[number % len(trials)], counterpart_seed(number)
        yield EpisodeSpec(trial, seed, f"{trial.name}, seed {seed}", secret=False)


def run_within(
    clock: SubmissionClock,
    run: Callable[[], Evidence],
    label: str,
    *,
    secret: bool = False,
    progress: str | None = None,
) -> Evidence:
    """Returns the evidence that ``run`` makes; where nothing more of the submission is run, a record of why.

    ``progress``: what is shown while it runs; by default the label.
    """
    refusal = clock.refusal()
    if refusal is not None:
        return EvidenceRecord(failure=refusal, label=label, secret=secret, outcome="not run")
    clock.show_progress(label if progress is None else progress)
    evidence = run()
    clock.note(evidence.failure)
    return evidence


class EpisodeCollector:
    """Runs each episode of one submission when a criterion first needs it."""

    def __init__(
        self, assignment: Assignment, options: EvidenceOptions, run: Callable[[EpisodeSpec], Evidence]
    ) -> None:
        """``run``: runs one episode. Its failures are evidence too; whatever it raises is the grader's error."""
        self.level = options.level
        self._assignment = assignment
        self._secret = options.secret
        self._clock = options.clock
        self._run = run
        self._evidence: dict[tuple[str, bool, int], Evidence] = {}
        self._counterparts: dict[tuple[str, int], Evidence] = {}

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        specs = episode_specs(self._assignment, criterion, secret=self._secret)
        return [self._evidence_of(spec) for spec in specs]

    def collected(self) -> Sequence[Evidence]:
        return list(self._evidence.values())

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        for spec in counterpart_specs(self._assignment, criterion):
            key = spec.trial.name, spec.seed
            if key not in self._counterparts:
                if self._clock.refusal() is not None:
                    return
                self._clock.show_progress(f"looking for an example: {spec.label}")
                self._counterparts[key] = self._run(spec)
            yield self._counterparts[key]

    def _evidence_of(self, spec: EpisodeSpec) -> Evidence:
        key = spec.trial.name, spec.secret, spec.seed
        if key not in self._evidence:
            progress = f"episode {len(self._evidence) + 1} of {self._episode_count}: {spec.label}"
            self._evidence[key] = run_within(
                self._clock, lambda: self._run(spec), spec.label, secret=spec.secret, progress=progress
            )
        return self._evidence[key]

    @cached_property
    def _episode_count(self) -> int:
        """How many episodes all criteria need."""
        every = (
            episode_specs(self._assignment, each, secret=self._secret) for each in self._assignment.criteria
        )
        return len({(spec.trial.name, spec.secret, spec.seed) for specs in every for spec in specs})
