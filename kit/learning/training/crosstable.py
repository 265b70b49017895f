"""A cross table: policies of a sweep, each trained on some cases of a task and tested on all (dissertation, Table 3.5)."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import fmean
from typing import Final

import numpy as np

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.field_types import check_field_types
from kit.host.job_executors import read_result
from kit.learning.policies.evaluation import Evaluator
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training_sweep import ALL_CASES, TrainingSweep
from kit.workspace import write_atomically

TEST_FILE: Final = "tested-on-all.json"
"""In a run's folder: the test of its policy, which is made once."""


@dataclass(frozen=True, slots=True)
class CrosstableColumn:
    """One group of cases trained on: means over its seeds."""

    group: str
    steps: float
    seconds: float
    shares: Mapping[str, float]
    """Success by tested case."""
    adjacency: Mapping[str, float] = field(default_factory=dict)
    """Share of steps in which two robots were side by side by their rays, by case. Empty for one robot."""

    @property
    def mean(self) -> float:
        return float(np.mean([*self.shares.values()]))

    @property
    def spread(self) -> float:
        """Standard deviation over the cases, of the population: that is what the dissertation's Table 3.5 gives."""
        return float(np.std([*self.shares.values()]))


def case_groups(task: TaskSpec) -> tuple[str, ...]:
    """The task's groups of more than one case, and all cases together."""
    groups = [case.group for _, case in task.resolve().map_cases() if case.group]
    return (*(group for group in dict.fromkeys(groups) if groups.count(group) > 1), ALL_CASES)


def check_crosstable(configs: Sequence[RunConfig]) -> None:
    """Raises RunError unless the trainings differ in their cases and seeds alone."""
    if len({replace(config, choice=replace(config.choice, on=()), seed=0) for config in configs}) > 1:
        raise RunError(
            "A cross table compares groups of cases: give one task, algorithm, preset, reward and number per setting."
        )


def crosstable_columns(sweep: TrainingSweep) -> tuple[CrosstableColumn, ...]:
    """Tests what is untested; a column for each group of cases that has a trained policy, in the order of the sweep."""
    tests: dict[str, list[CrosstableColumn]] = {}
    for entry in sweep.entries():
        result = sweep.result(entry.key)
        if result is not None and not result.problem:
            column = _test_run(sweep.run_of(entry), entry.config, sweep.episodes)
            tests.setdefault(column.group, []).append(column)
    return tuple(_mean_column(columns) for columns in tests.values())


def _test_run(run: TrainingRun, config: RunConfig, episodes: int) -> CrosstableColumn:
    """The run's policy on all cases; tested once, then read."""
    file = run.folder / TEST_FILE
    task = replace(config.choice, on=()).resolve()
    cases = {case.name for _, case in task.map_cases()}
    try:
        stored = read_result(file)
        check_field_types(CrosstableColumn, stored)
        of_pairs = cases if task.robots > 1 else set()
        if stored["shares"].keys() != cases or stored["adjacency"].keys() != of_pairs:
            raise ValueError("a test on other cases")
    except (OSError, ValueError, KeyError, TypeError):  # there is none, or one of somebody else's
        policy = run.policy()
        evaluator = Evaluator(replace(policy.trained_on, on=()).resolve())
        result = evaluator.test(policy, episodes, derive_seed(config.seed, "crosstable"))
        stored = {"shares": {case.case: case.share for case in result.cases}, "adjacency": {}}
        if result.is_pair:
            stored["adjacency"] = {case.case: case.adjacency for case in result.cases}
        write_atomically(file, json.dumps(stored).encode())
    summary, group = run.summary(), ", ".join(config.choice.on) or ALL_CASES
    return CrosstableColumn(group, summary.steps, summary.seconds, stored["shares"], stored["adjacency"])


def _mean_column(columns: Sequence[CrosstableColumn]) -> CrosstableColumn:
    """The column of several seeds."""
    first = columns[0]
    return CrosstableColumn(
        first.group,
        fmean(column.steps for column in columns),
        fmean(column.seconds for column in columns),
        {case: fmean(column.shares[case] for column in columns) for case in first.shares},
        {case: fmean(column.adjacency[case] for column in columns) for case in first.adjacency},
    )


def crosstable_tables(columns: Sequence[CrosstableColumn], compare: Mapping[str, float]) -> list[Table]:
    """A row for each case tested on; means, and below them ``compare``, the means of the dissertation for this task, by group.
    For pairs a second table of how long the two robots are side by side."""
    cases = list(columns[0].shares)
    rows: list[tuple[Cell, ...]] = [
        *_case_rows(cases, [column.shares for column in columns]),
        ("spread", *(column.spread for column in columns)),
        ("steps", *(f"{column.steps:,.0f}" for column in columns)),
        ("seconds", *(f"{column.seconds:.0f}" for column in columns)),
    ]
    if any(column.group in compare for column in columns):
        rows.append(("dissertation", *(compare.get(column.group, "") for column in columns)))
    heads = (Column("tested on", CellStyle.TEXT), *(Column(column.group, decimals=3) for column in columns))
    tables = [Table("crosstable", "", heads, tuple(rows), is_ruled=False)]
    if all(column.adjacency for column in columns):
        title = "side by side, as rays tell: the share of an episode's steps (equations 4.7 to 4.9)"
        beside = _case_rows(cases, [column.adjacency for column in columns])
        tables.append(Table("crosstable-adjacency", title, heads, tuple(beside), is_ruled=False))
    return tables


def _case_rows(cases: Sequence[str], columns: Sequence[Mapping[str, float]]) -> list[tuple[Cell, ...]]:
    """A row for each case, and their mean."""
    rows: list[tuple[Cell, ...]] = [(case, *(column[case] for column in columns)) for case in cases]
    return [*rows, ("mean", *(fmean(column.values()) for column in columns))]
