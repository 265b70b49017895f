"""Collects evidence about a controller: episodes, each in a fresh process."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from grader.assignment import Assignment, Criterion, SeedSet, Trial
from grader.evidence.drive_record import GradedDrive
from grader.evidence.episodes import EpisodeSpec, run_episode
from kit.host.sandbox.confinement import Level


class ControllerEpisodes:
    """Runs each episode of one submission when a criterion first needs it."""

    def __init__(self, assignment: Assignment, file: Path, *, level: Level, secret: bool) -> None:
        self.level = level
        self._assignment = assignment
        self._file = file
        self._secret = secret
        self._drives: dict[tuple[str, bool, int], GradedDrive] = {}

    def evidence(self, criterion: Criterion) -> Sequence[GradedDrive]:
        return [
            self._drive(self._assignment.trial(name), number, seed, secret)
            for name in criterion.trials
            for secret, number, seed in self._seeds(self._assignment.trial(name), criterion.seeds)
        ]

    def collected(self) -> Sequence[GradedDrive]:
        return list(self._drives.values())

    def _seeds(self, trial: Trial, which: SeedSet) -> list[tuple[bool, int, int]]:
        """Returns for each seed whether it is secret, its number from 1 among its kind, and the seed."""
        public = list(enumerate(trial.seeds, 1)) if which is not SeedSet.SECRET else []
        secret = (
            list(enumerate(trial.secret_seeds, 1)) if which is not SeedSet.PUBLIC and self._secret else []
        )
        return [(False, *each) for each in public] + [(True, *each) for each in secret]

    def _drive(self, trial: Trial, number: int, seed: int, secret: bool) -> GradedDrive:
        key = trial.name, secret, seed
        if key not in self._drives:
            label = f"{trial.name}, secret seed {number}" if secret else f"{trial.name}, seed {seed}"
            self._drives[key] = self._run(EpisodeSpec(trial, seed, label, secret))
        return self._drives[key]

    def _run(self, spec: EpisodeSpec) -> GradedDrive:
        return run_episode(spec, self._file, limits=self._assignment.limits, level=self.level)
