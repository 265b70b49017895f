"""Trains and tests again, by the dissertation's settings, the agents of a printed table: ``kit study NUMBER --again``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from kit.learning.environment.task_spec import TaskSpec
from kit.learning.policies.evaluation import Evaluator, derive_seed
from kit.learning.training.optional_deps import versions
from kit.learning.training.runs import PresetName, RunConfig, RunError
from kit.learning.training.training import resolve_preset
from kit.learning.training.training_sweep import SweepEntry, TrainingSweep, combine
from kit.study.printed_tables import PrintedTable, printed_table
from kit.study.recorded_results import (
    RecordedResult,
    RecordedSettings,
    RecordedTest,
    append_event,
    read_recorded_result,
    recorded_result_file,
)
from kit.workspace import Workspace

MEASURED_RATE: Final = 195.0
"""Steps per second of one such training: 20,000 took 102 s on a busy core of a virtual machine. Used until this workspace has
timed one of its own."""


@dataclass(frozen=True, slots=True)
class StudyRun:
    """The agents of one table: one for each group of cases and seed.

    Their trainings lie in the workspace, a sweep for each seed; what came of them is added to the table's event log.
    """

    table: PrintedTable
    workspace: Workspace
    algorithm: str = "boltzmann-dqn"
    preset: PresetName = "seed"
    episodes: int = 100
    """Of each case in a test, as in the dissertation."""
    steps: int | None = None
    """At most, of each training; None: as the preset says."""

    @property
    def settings(self) -> RecordedSettings:
        return RecordedSettings(
            self.table.id,
            self.table.repeat_task,
            self.algorithm,
            self.preset,
            self.episodes,
            self.steps,
            versions(),
        )

    def recorded(self) -> RecordedResult | None:
        """What there is so far. Raises RecordedResultError; RunError if it was made by other settings."""
        found = read_recorded_result(recorded_result_file(self.workspace, self.table.id))
        if found is not None and replace(found.settings, versions={}) != replace(self.settings, versions={}):
            raise RunError(f"{found.file} was made by other settings. Rename it; then a new one is begun.")
        return found

    def sweep(self, seed: int) -> TrainingSweep:
        """The trainings from one seed; makes their folder. Raises RunError and OSError."""
        folder = self.workspace.folder / "study" / self.table.id / f"seed-{seed}"
        return TrainingSweep.prepare(folder, self.configs(seed), self.episodes)

    def configs(self, seed: int) -> tuple[RunConfig, ...]:
        """One for each group of cases."""
        return combine(
            (self.table.repeat_task,),
            cases=self.table.trained_groups,
            algorithms=(self.algorithm,),
            presets=(self.preset,),
            seeds=(seed,),
            steps=self.steps,
        )

    def missing_seeds(self, seeds: int) -> tuple[int, ...]:
        """Those of the seeds from 0 on of which an agent has not been tested yet."""
        found = self.recorded()
        return tuple(
            seed
            for seed in range(seeds)
            if found is None or not all(found.has_test(group, seed) for group in self.table.trained_groups)
        )

    def record(self, sweep: TrainingSweep, seed: int, on_test: Callable[[RecordedTest], None]) -> None:
        """Tests the agents that have been trained and not been tested; adds each to the log.

        Raises RunError if a training failed, with its reason; OSError.
        """
        file = recorded_result_file(self.workspace, self.table.id)
        found = self.recorded()
        if found is None:
            append_event(file, self.settings)
        problems = []
        for group, entry in zip(self.table.trained_groups, sweep.entries(), strict=True):
            if found is not None and found.has_test(group, seed):
                continue
            result = sweep.result(entry.key)
            if result is None or result.problem:
                problems.append(f"{group}, seed {seed}: {result.problem if result else 'not trained yet'}")
                continue
            test = _test_agent(group, sweep, entry, self.episodes)
            append_event(file, test)
            on_test(test)
        if problems:
            raise RunError("\n".join([*problems, "The same command goes on."]))

    def expected_seconds(self, seeds: int, jobs: int) -> tuple[float, float]:
        """About how long the missing trainings take: if they need as many steps as the dissertation's did; and at most."""
        printed = printed_table(self.table.steps_table)
        groups = len(self.table.trained_groups)
        steps = sum(printed.cell(row, "steps") for row in printed.rows)
        most = groups * resolve_preset(self.configs(0)[0]).steps
        found = self.recorded()
        rate = (found.rate if found else None) or MEASURED_RATE
        at_once = rate * min(jobs, groups)
        missing = len(self.missing_seeds(seeds))
        return missing * steps / at_once, missing * most / at_once


def _test_agent(group: str, sweep: TrainingSweep, entry: SweepEntry, episodes: int) -> RecordedTest:
    """Tests the agent on all cases of its task."""
    config = entry.config
    run = sweep.run_of(entry)
    task = TaskSpec(config.choice.task).resolve()
    found = Evaluator(task).test(run.policy(), episodes, derive_seed(config.seed, "study"))
    summary = run.summary()
    return RecordedTest(
        group,
        config.seed,
        summary.steps,
        round(summary.seconds, 1),
        episodes,
        {case.case: case.reached for case in found.cases},
        {case.case: round(case.adjacency, 4) for case in found.cases if not np.isnan(case.adjacency)},
    )
