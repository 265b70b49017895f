"""Trains and tests again the agents of a printed table, runs its controllers, and records what came of it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from kit.controllers import find_controller
from kit.learning.policies.evaluation import EpisodeShare, Evaluator
from kit.learning.policies.seeds import derive_seed
from kit.learning.training.events import Evaluated, EventReader
from kit.learning.training.learn_extra import versions
from kit.learning.training.measures import VALUE_MAX
from kit.learning.training.run_config import PresetName, RunConfig, RunError, format_settings
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training import resolve_preset
from kit.learning.training.training_sweep import SweepEntry, TrainingSweep, combine
from kit.run.scenario import find_scenario
from kit.study.kit_commit import kit_commit
from kit.study.pairs import PairRunResult, run_once, shift_start_poses
from kit.study.printed_tables import (
    FIGURE,
    POTENTIAL_FIELDS,
    STEPS,
    WITH_TARGET,
    PrintedFigure,
    PrintedTable,
    parts_of,
    path_figures,
    printed_table,
)
from kit.study.recorded_results import (
    RecordedPath,
    RecordedResult,
    RecordedSettings,
    RecordedTest,
    TrainingSession,
)
from kit.study.result_logs import (
    append_event,
    log_name,
    read_recorded_result,
    recorded_result_file,
    source_number,
)
from kit.study.study_paths import agent_paths, controller_path, missing_paths
from kit.study.study_variants import CONTROLLERS, VARIANT_OPTIONS, StudyVariant
from kit.workspace import Workspace

MEASURED_RATES: Final = {("boltzmann-dqn", "seed"): 800.0, ("ppo", "seed"): 700.0, ("ppo", "kit"): 25_000.0}
"""Steps per second of one training by algorithm and preset, on a busy core of a virtual machine. Used until this workspace has
timed one of its own."""
FIELDS_RUNS: Final = 20
"""Runs per case by potential fields, as in the dissertation."""
FIELDS_RUN_S: Final = 8.0
"""About how long one of them takes, on such a core."""


@dataclass(frozen=True, slots=True)
class StudyRun:
    """The agents of one table: one for each group of cases and seed.

    Their trainings lie in the workspace, a sweep for each seed; what came of them is added to the table's event log.
    """

    table: PrintedTable
    workspace: Workspace
    algorithm: str
    preset: PresetName
    variant: StudyVariant = "seed"
    episodes: int = 100
    """Episodes per case in a test, as in the dissertation."""
    steps: int | None = None
    """Most steps of each training; None: the preset's."""
    only: tuple[str, ...] = ()
    """Some of the groups; all where empty."""

    @classmethod
    def of(
        cls,
        table: PrintedTable,
        workspace: Workspace,
        variant: StudyVariant = "seed",
        steps: int | None = None,
    ) -> StudyRun:
        """Makes a run with the dissertation's settings, with all of them but the limit of values, or with the kit's own preset.

        The agents of a table may be some of those of another one.
        """
        source = printed_table(source_number(table))
        only = table.row_groups if table.results_of else ()
        steps = steps or source.keep_training or None
        if variant == "kit":
            return cls(source, workspace, "ppo", "kit", variant, steps=steps, only=only)
        return cls(source, workspace, source.algorithm, "seed", variant, steps=steps, only=only)

    @property
    def changed(self) -> tuple[tuple[str, float], ...]:
        """Settings of the algorithm that differ from the preset's."""
        return (("value_limit", math.inf),) if self.variant == "no-limit" else ()

    @property
    def task(self) -> str:
        return self.table.kit_task if self.variant == "kit" else self.table.repeat_task

    @property
    def groups(self) -> tuple[str, ...]:
        """The groups of cases that agents are trained on; none where potential fields alone drive."""
        if not self.task or not self._can_be_varied:
            return ()
        known = self.table.trained_groups
        parts = [set(part.row_groups) for part in parts_of(self.table.id)]
        # What another table shows alone comes first: a sweep of it may grow to this one.
        alone = [group for part in parts if part < set(known) for group in known if group in part]
        ordered = dict.fromkeys((*alone, *known))
        return tuple(group for group in ordered if group in (self.only or known))

    @property
    def _can_be_varied(self) -> bool:
        """Whether there is a limit of values that can be taken away, if it is to be."""
        return self.variant != "no-limit" or self.algorithm == "boltzmann-dqn"

    @property
    def has_potential_fields(self) -> bool:
        return self.table.has_potential_fields and self.variant in CONTROLLERS and not self.only

    @property
    def settings(self) -> RecordedSettings:
        option = VARIANT_OPTIONS[self.variant]
        option += "" if self.steps is None else f" --steps {self.steps}"
        return RecordedSettings(
            self.table.id,
            self.task,
            self.algorithm,
            self.preset,
            self.episodes,
            self.steps,
            versions(),
            f"kit study {self.table.id.replace(FIGURE, 'figure ')} --again{option}",
            kit_commit(),
            format_settings(self.changed),
        )

    @property
    def log(self) -> Path:
        return recorded_result_file(self.workspace, self.table.id, self.variant)

    def read_recorded(self) -> RecordedResult | None:
        """Reads the results that there are so far. Raises RecordedResultError; RunError if it was made by other settings."""
        found = read_recorded_result(self.log)
        if found is not None and _comparable_settings(found.settings) != _comparable_settings(self.settings):
            raise RunError(f"{found.file} was made by other settings. Rename it; then a new one is begun.")
        return found

    def sweep(self, seed: int) -> TrainingSweep:
        """The trainings from one seed; makes their folder. Raises RunError and OSError."""
        folder = self.workspace.folder / "study" / log_name(self.table.id, self.variant) / f"seed-{seed}"
        return TrainingSweep.prepare(folder, self.configs(seed), self.episodes, grows=True)

    def configs(self, seed: int) -> tuple[RunConfig, ...]:
        """One for each group of cases."""
        found = []
        for group in self.groups:
            (config,) = combine(
                (self.task,),
                cases=("all" if group == WITH_TARGET else group,),
                algorithms=(self.algorithm,),
                presets=(self.preset,),
                seeds=(seed,),
                steps=self.steps,
                settings={name: (number,) for name, number in self.changed},
            )
            config = replace(config, keep_training=bool(self.table.keep_training))
            if group == WITH_TARGET:
                choice = replace(config.choice, tells_target=True, reward="algorithm-1-target")
                config = replace(config, choice=choice)
            found.append(config)
        return tuple(found)

    def missing_seeds(self, seeds: int) -> tuple[int, ...]:
        """The seeds, counted from 0, whose agent has not been tested yet."""
        found = self.read_recorded()
        return tuple(
            seed
            for seed in range(seeds)
            if self.groups
            and (found is None or not all(found.has_test(group, seed) for group in self.groups))
        )

    @property
    def misses_fields(self) -> bool:
        """Whether potential fields have not been run on every case yet."""
        return bool(self.missing_fields_cases)

    @property
    def fields_cases(self) -> tuple[tuple[str, str], ...]:
        """The map and name of every case that the dissertation gives potential fields a result for."""
        if not self.has_potential_fields:
            return ()
        printed = self.table.case_cells(self.table.columns[self.table.groups.index(POTENTIAL_FIELDS)])
        return tuple((place, case) for place, case in self.table.cases if case in printed)

    @property
    def missing_fields_cases(self) -> tuple[tuple[str, str], ...]:
        """The cases that are not in the log."""
        found = self.read_recorded()
        done = (
            {case for each in found.tests_of(POTENTIAL_FIELDS) for case in each.reached} if found else set()
        )
        return tuple((place, case) for place, case in self.fields_cases if case not in done)

    @property
    def fields_runs(self) -> int:
        """Number of runs of all missing cases."""
        return FIELDS_RUNS * len(self.missing_fields_cases)

    def _begin_log(self) -> RecordedResult | None:
        found = self.read_recorded()
        if found is None:
            append_event(self.log, self.settings)
        return found

    def record(self, sweep: TrainingSweep, seed: int, on_test: Callable[[RecordedTest], None]) -> None:
        """Tests the agents that have been trained and not been tested; adds each to the log.

        Raises RunError if a training failed, with its reason; OSError.
        """
        found = self._begin_log()
        problems = []
        for group, entry in zip(self.groups, sweep.entries(), strict=False):
            if found is not None and found.has_test(group, seed):
                continue
            result = sweep.result(entry.key)
            if result is None or result.problem:
                problems.append(f"{group}, seed {seed}: {result.problem if result else 'not trained yet'}")
                continue
            test = _test_agent(group, sweep, entry, self.episodes)
            append_event(self.log, test)
            on_test(test)
        if problems:
            raise RunError("\n".join([*problems, "The same command goes on."]))

    def record_fields(
        self, on_run: Callable[[str, int], None] = lambda case, number: None, *, runs: int = FIELDS_RUNS
    ) -> None:
        """Runs the potential fields on every case that has a printed result and none in the log; adds each to the log.

        ``on_run``: called after each run with its case and number. Raises RunError if the controller failed.
        """
        missing = self.missing_fields_cases
        self._begin_log()
        controller = find_controller(CONTROLLERS[self.variant])
        for place, case in missing:
            began, scenario, outcomes = time.monotonic(), find_scenario(place, case), list[PairRunResult]()
            for number in range(runs):
                outcomes.append(run_once(shift_start_poses(scenario, 0, number), controller, seed=number))
                if (
                    outcomes[-1].end == "failed"
                ):  # the program did, perhaps on a machine too slow for it: no result
                    raise RunError(f"{case}, run {number}: {outcomes[-1].why} The same command goes on.")
                on_run(case, number)
            reached = {case: sum(each.end == "reached" for each in outcomes)}
            shares = [each.by_rays for each in outcomes]
            arrived = [each for each in outcomes if each.end == "reached"]
            by_rays = EpisodeShare.of([each.by_rays for each in arrived])
            by_poses = EpisodeShare.of([each.by_geometry for each in arrived])
            spread = {case: round(float(np.std(shares, ddof=1)), 4)} if runs > 1 else {}
            test = RecordedTest(
                POTENTIAL_FIELDS,
                0,
                0,
                round(time.monotonic() - began, 1),
                runs,
                reached,
                {case: round(float(np.mean(shares)), 4)},
                adjacency_sd=spread,
                by_poses={case: round(float(np.mean([each.by_geometry for each in outcomes])), 4)},
                reached_by_rays=_known_shares({case: by_rays.mean}),
                reached_by_rays_sd=_known_shares({case: by_rays.sd}),
                reached_by_poses=_known_shares({case: by_poses.mean}),
            )
            append_event(self.log, test)

    def missing_paths(self) -> tuple[PrintedFigure, ...]:
        """The pictures of ways whose agent or controller has been tested and whose ways are not in the log."""
        found = self.read_recorded()
        figures = path_figures(self.table.id) if self.variant == "seed" and found is not None else ()
        return tuple(
            figure
            for figure in missing_paths(figures, found)
            if found is not None and found.has_test(figure.group, 0)
        )

    def record_paths(self, on_figure: Callable[[PrintedFigure], None] = lambda figure: None) -> None:
        """Drives the ways of every picture that has none in the log, and adds them to it.

        An agent whose training is no longer in the workspace is left out. Raises RunError if a controller failed.
        """
        for figure in self.missing_paths():
            ways = (
                self._fields_paths(figure) if figure.group == POTENTIAL_FIELDS else self._agent_paths(figure)
            )
            for way in ways:
                append_event(self.log, way)
            if ways:
                on_figure(figure)

    def _agent_paths(self, figure: PrintedFigure) -> tuple[RecordedPath, ...]:
        sweep = self.sweep(0)
        entry = sweep.entries()[self.groups.index(figure.group)]
        result = sweep.result(entry.key)
        if result is None or result.problem:
            return ()
        task = replace(entry.config.choice, on=tuple(case for _, case in figure.paths)).resolve()
        return agent_paths(figure, sweep.run_of(entry).policy(), task, 0, derive_seed(0, "study paths"))

    def _fields_paths(self, figure: PrintedFigure) -> tuple[RecordedPath, ...]:
        controller = find_controller(CONTROLLERS[self.variant])
        found = []
        for place, case in figure.paths:
            scenario = find_scenario(place, case)
            assert scenario.case is not None  # it was found by its name
            for number in range(figure.episodes):
                outcome = run_once(shift_start_poses(scenario, 0, number), controller, seed=number)
                found.append(controller_path(case, scenario.case.target, outcome))
        return tuple(found)

    def expected_seconds(self, seeds: int, jobs: int) -> tuple[float, float]:
        """About how long the missing trainings take: if they need as many steps as the dissertation's did; and at most.

        By the kit's own preset, both are of all its steps.
        """
        groups = len(self.groups)
        fields = self.fields_runs * FIELDS_RUN_S if self.misses_fields else 0.0
        if not groups:
            return fields, fields
        most = sum(resolve_preset(config).steps for config in self.configs(0))
        steps = most if self.variant == "kit" else _printed_steps(self.table)
        found = self.read_recorded()
        rate = (found.rate if found else None) or MEASURED_RATES.get((self.algorithm, self.preset), 500.0)
        at_once = rate * min(jobs, groups)
        missing = len(self.missing_seeds(seeds))
        return fields + missing * steps / at_once, fields + missing * most / at_once


def _comparable_settings(settings: RecordedSettings) -> RecordedSettings:
    """Returns settings without what may differ from one part of a log to the next."""
    return replace(settings, versions={}, command="", commit="")


def _printed_steps(table: PrintedTable) -> float:
    """The steps that all its trainings from one seed took in the dissertation."""
    if table.keep_training:
        return table.keep_training
    printed = printed_table(table.steps_table) if table.steps_table else table
    columns = [
        title for title, measure in zip(printed.columns, printed.measures, strict=True) if measure == STEPS
    ]
    rows = list(printed.rows)[: len(printed.row_groups) or printed.attempts]
    total = sum(printed.cell(row, column) for row in rows for column in columns)
    return total / printed.attempts


def _test_agent(group: str, sweep: TrainingSweep, entry: SweepEntry, episodes: int) -> RecordedTest:
    """Tests the agent on all cases of its task."""
    config = entry.config
    run = sweep.run_of(entry)
    task = replace(config.choice, on=()).resolve()
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
        tuple(case.name for _, case in config.choice.resolve().map_cases()),
        _training_sessions(run),
        {case.case: round(case.adjacency_sd, 4) for case in found.cases if not np.isnan(case.adjacency_sd)},
        reached_by_rays=_known_shares({case.case: case.reached_by_rays.mean for case in found.cases}),
        reached_by_rays_sd=_known_shares({case.case: case.reached_by_rays.sd for case in found.cases}),
        reached_by_poses=_known_shares({case.case: case.reached_by_poses.mean for case in found.cases}),
    )


def _known_shares(shares: dict[str, float]) -> dict[str, float]:
    """The shares that are numbers, rounded."""
    return {case: round(share, 4) for case, share in shares.items() if not np.isnan(share)}


def _training_sessions(run: TrainingRun) -> tuple[TrainingSession, ...]:
    """The tests while it was trained."""
    found = []
    for event in EventReader(run.events_file).read_new():
        if isinstance(event, Evaluated):
            reached, collided, timed_out = np.array(list(event.cases.values())).sum(axis=0).tolist()
            reward = None if event.reward is None else round(event.reward, 1)
            adjacency = None if event.adjacency is None else round(event.adjacency, 3)
            largest = event.measures.get(VALUE_MAX)
            value = None if largest is None else round(largest, 1)
            found.append(TrainingSession(event.steps, reached, collided, timed_out, reward, adjacency, value))
    return tuple(found)
