"""The contract between evidence, checks and grading: what a piece of evidence offers, and who collects it.

Checks measure evidence and never see the student's program. Whatever collects it runs the program at a confinement
level, and records what it did.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import chain
from pathlib import Path
from typing import Any, ClassVar, Final, Protocol, runtime_checkable

from grader.assignment import MAX_COUNTERPARTS, Assignment, Criterion, Trial
from grader.evidence.submission_clock import SubmissionClock
from grader.seeds import SeedSet, counterpart_seed
from kit.host.failure import Failure, FailureKind
from kit.host.sandbox.sandbox_config import Level


@dataclass(frozen=True, slots=True)
class EvidenceOptions:
    """How to collect evidence about one submission."""

    level: Level
    """The confinement level of the program: one that this machine has."""
    secret: bool
    """Whether the secret seeds are used too."""
    clock: SubmissionClock = field(default_factory=SubmissionClock)
    """The wall clock of the whole submission."""
    stops_at_death: bool = False
    """Whether no further episode is run of a program that has died in one: a student's own check, who mends that first."""


class Evidence(Protocol):
    """Something a criterion is measured on: one drive, one reward function, one set of trainings."""

    @property
    def label(self) -> str:
        """Names it without giving a secret away: ``maze, secret seed 2``."""

    @property
    def secret(self) -> bool:
        """True if it comes from a secret seed."""

    @property
    def failure(self) -> Failure | None:
        """Why the program failed; None if it did not."""

    @property
    def outcome(self) -> str:
        """How the episode ended, in a few words."""

    @property
    def steps(self) -> int:
        """How many steps were simulated."""

    @property
    def printed(self) -> tuple[str, ...]:
        """The lines that the program printed."""

    def explain(self, check: str, params: Any) -> str:
        """A sentence about what a check found in it, for the student; may be empty."""

    def picture(self, check: str = "") -> str:
        """A picture of it in plain characters, for a check; may be empty."""


@runtime_checkable
class WatchableEvidence(Protocol):
    """Evidence whose picture shows an episode."""

    def replay_title(self) -> str:
        """Names what the picture shows; empty if there is nothing to watch."""

    def save_replay(self, file: Path) -> bool:
        """Saves the episode for ``kit replay``; returns whether it needs the assignment's own world files. Raises OSError."""


class EvidenceCollector(Protocol):
    """Runs a submission and records what it does."""

    level: Level

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        """The evidence for a criterion; runs what has not run yet."""

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        """The part of it that no secret decides; runs what of that has not run yet."""

    def collected(self) -> Sequence[Evidence]:
        """All evidence collected so far, except counterparts."""

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        """Yields a few more pieces of public evidence, each run when it is asked for.

        They show a student what goes wrong where only secret evidence loses points, and decide no points. What a program
        says in them is shown, so they are run before anything secret is.
        """


class EvidenceSource(Protocol):
    """Evidence by a criterion's id: what teacher tests are given."""

    @property
    def has_given_secrets(self) -> bool:
        """Whether any evidence that it has returned is secret."""

    def evidence(self, criterion_id: str) -> Sequence[Evidence]:
        """The evidence that this criterion is judged on. Raises StopIteration for an unknown id."""


@dataclass(eq=False)
class EvidenceRecord:
    """Evidence whose content is a record of its kind's own, or a failure."""

    content: Any = None
    """The kind's own record, for its checks."""
    failure: Failure | None = None
    label: str = "what you handed in"
    secret: bool = False
    outcome: str = "examined"
    steps: int = 0
    printed: tuple[str, ...] = ()
    explain_with: Callable[[str, Any], str] = lambda check, params: ""
    """(name of a check, its params) -> the sentence that ``explain`` returns."""
    draw_with: Callable[[str], str] = lambda check: ""
    """(name of a check) -> the picture."""

    def explain(self, check: str, params: Any) -> str:
        return self.explain_with(check, params)

    def picture(self, check: str = "") -> str:
        return self.draw_with(check)


class FixedEvidence:
    """A collector of evidence that is complete from the start, the same for every criterion, and public."""

    def __init__(self, evidence: Sequence[Evidence], level: Level) -> None:
        self.level = level
        self._evidence = tuple(evidence)

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._evidence

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self._evidence

    def collected(self) -> Sequence[Evidence]:
        return self._evidence

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        return iter(())


class SingleEvidence:
    """A collector of one piece of evidence, the same for every criterion, which is collected when it is first needed."""

    def __init__(
        self,
        collect: Callable[[], Evidence],
        level: Level,
        collect_counterpart: Callable[[], Evidence] | None = None,
        *,
        runs_program: bool = True,
    ) -> None:
        """``collect_counterpart``: collects the same with the public seeds, where what ``collect`` collects is secret.
        ``runs_program``: whether a program of the submission's runs. If not, whoever checks their own work is shown the secret
        evidence itself, and nothing is collected twice."""
        self.level = level
        self._has_counterpart = runs_program or level is not Level.LIMITED
        self._collect = collect
        self._evidence: Evidence | None = None
        self._collect_counterpart = collect_counterpart
        self._counterpart: Evidence | None = None

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        if self._evidence is None:
            self._evidence = self._collect()
        return (self._evidence,)

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return self.evidence(criterion) if self._collect_counterpart is None else ()

    def collected(self) -> Sequence[Evidence]:
        return () if self._evidence is None else (self._evidence,)

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        if self._collect_counterpart is None or not self._has_counterpart:
            return
        if self._counterpart is None:
            self._counterpart = self._collect_counterpart()
        yield self._counterpart


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


class CachingCollector:
    """Collects each piece of evidence of one submission when a criterion first needs it."""

    stops_after_timeouts: ClassVar[bool] = True
    """Whether nothing more is run once two pieces of evidence have taken too long."""

    def __init__(self, options: EvidenceOptions) -> None:
        self.level = options.level
        self._clock = options.clock
        self._evidence: dict[Hashable, Evidence] = {}
        self._counterparts: dict[Hashable, Evidence] = {}

    def collected(self) -> Sequence[Evidence]:
        return list(self._evidence.values())

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        """Yields nothing: secret evidence of this kind has no public counterparts."""
        return iter(())

    def _collect(
        self, key: Hashable, run: Callable[[], Evidence], label: str, *, secret: bool, progress: str = ""
    ) -> Evidence:
        """Returns the evidence that ``run`` made of this key; where nothing more of the submission is run, a record of why.

        ``progress``: what is shown while it runs; by default the label.
        """
        if key not in self._evidence:
            if (refusal := self._clock.refusal()) is not None:
                return self._skip(key, refusal, label, secret=secret)
            self._clock.show_progress(progress or label)
            self._evidence[key] = evidence = run()
            if self.stops_after_timeouts:
                self._clock.note(evidence.failure)
        return self._evidence[key]

    def _skip(self, key: Hashable, failure: Failure, label: str, *, secret: bool) -> Evidence:
        """Returns the evidence of this key; where there is none yet, a record of why it was not run."""
        record = EvidenceRecord(failure=failure, label=label, secret=secret, outcome="not run")
        return self._evidence.setdefault(key, record)

    def _collect_counterparts(
        self, runs: Iterable[tuple[Hashable, str, Callable[[], Evidence]]]
    ) -> Iterator[Evidence]:
        """Yields the counterpart of each (key, label, run), as long as the submission may run."""
        for key, label, run in runs:
            if key not in self._counterparts:
                if self._clock.refusal() is not None:
                    return
                self._clock.show_progress(f"looking for an example: {label}")
                self._counterparts[key] = run()
            yield self._counterparts[key]


DEATHS: Final = frozenset((FailureKind.EXCEPTION, FailureKind.EXIT, FailureKind.TIMEOUT))
"""Failures that end a program by its own doing, or since it would not end."""


class EpisodeCollector(CachingCollector):
    """Runs each episode of one submission when a criterion first needs it."""

    def __init__(
        self,
        assignment: Assignment,
        options: EvidenceOptions,
        run: Callable[[EpisodeSpec], Evidence],
        criteria: Sequence[Criterion] | None = None,
    ) -> None:
        """``run``: runs one episode. Its failures are evidence too; whatever it raises is the grader's error.
        ``criteria``: those that need episodes; by default all."""
        super().__init__(options)
        self._assignment = assignment
        self._secret = options.secret
        self._stops_at_death = options.stops_at_death
        self._death: Failure | None = None
        self._run = run
        self._criteria = assignment.criteria if criteria is None else criteria

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return [self._evidence_of(spec) for spec in self._episode_specs(criterion)]

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        return [self._evidence_of(spec) for spec in self._episode_specs(criterion) if not spec.secret]

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        specs = counterpart_specs(self._assignment, criterion)
        return self._collect_counterparts(
            ((spec.trial.name, spec.seed), spec.label, partial(self._run, spec)) for spec in specs
        )

    def _episode_specs(self, criterion: Criterion) -> Iterator[EpisodeSpec]:
        return episode_specs(self._assignment, criterion, secret=self._secret)

    def _evidence_of(self, spec: EpisodeSpec) -> Evidence:
        number = len(self._evidence) + 1
        key = (spec.trial.name, spec.secret, spec.seed)
        if self._death is not None:
            return self._skip(key, self._death, spec.label, secret=spec.secret)
        evidence = self._collect(
            key,
            lambda: self._run(spec),
            spec.label,
            secret=spec.secret,
            progress=f"episode {number} of {self._episode_count}: {spec.label}",
        )
        if self._stops_at_death and evidence.failure is not None and evidence.failure.kind in DEATHS:
            self._death = evidence.failure
        return evidence

    @cached_property
    def _episode_count(self) -> int:
        """How many episodes all criteria need."""
        specs = chain.from_iterable(map(self._episode_specs, self._criteria))
        return len({(spec.trial.name, spec.secret, spec.seed) for spec in specs})
