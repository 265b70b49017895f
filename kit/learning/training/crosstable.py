"""Trained on one group of cases, tested on all (dissertation, table 3.5). Made once, resumable at any time.

Every group is a run of its own in the table's folder; those that have ended are not run again. Two are trained at
once: one learner keeps one core busy.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from kit.learning.policies.evaluation import Evaluator, derive_seed
from kit.learning.training.runs import RunConfig, RunError, TrainingRun, create_run
from kit.learning.training.worker import start_worker
from kit.workspace import write_atomically

ALL_CASES = "all"


@dataclass(frozen=True, slots=True)
class GroupResult:
    """One group trained on."""

    group: str
    steps: int
    seconds: float
    shares: Mapping[str, float]
    """By case tested on."""
    adjacency: Mapping[str, float] = field(default_factory=dict)
    """By case: the share of steps in which two robots were side by side, as rays tell. Empty for one robot."""

    @property
    def mean(self) -> float:
        return float(np.mean([*self.shares.values()]))

    @property
    def spread(self) -> float:
        """Standard deviation over the cases, of the population: that is what the dissertation's Table 3.5 gives."""
        return float(np.std([*self.shares.values()]))


def case_groups(config: RunConfig) -> tuple[str, ...]:
    """The task's groups of more than one case, and all cases together."""
    groups = [case.group for _, case in config.choice.resolve().map_cases() if case.group]
    return (*(group for group in dict.fromkeys(groups) if groups.count(group) > 1), ALL_CASES)


def train_crosstable(
    folder: Path,
    config: RunConfig,
    groups: Sequence[str],
    *,
    episodes: int = 500,
    at_once: int | None = None,
    on_progress: Callable[[str], None] = lambda text: None,
) -> tuple[GroupResult, ...]:
    """Trains what is missing and tests what is untested; the columns in the order of ``groups``.

    ``folder`` holds the runs and is made if it is missing. ``on_progress`` is called with a line for each training that has ended. UnknownTask for a group
    that is none; RunError where a training fails, or the folder holds the table of something else.
    """
    folder.mkdir(parents=True, exist_ok=True)
    config = replace(config, choice=config.choice.frozen())
    configs = {group: _config_for_group(config, group) for group in groups}
    for each in configs.values():
        each.choice.resolve()
    with ThreadPoolExecutor(at_once or max(1, os.cpu_count() or 1)) as pool:
        futures = {pool.submit(_train_group, folder, group, each): group for group, each in configs.items()}
        for future in as_completed(futures):
            summary = future.result().summary()
            on_progress(f"trained on {futures[future]}: {summary.steps:,} steps, {summary.seconds:.0f} s")
    return tuple(_group_result(TrainingRun(folder / group), config, episodes) for group in groups)


def _config_for_group(config: RunConfig, group: str) -> RunConfig:
    on = config.choice.on if group == ALL_CASES else (group,)
    return replace(config, choice=replace(config.choice, on=on))


def _train_group(folder: Path, group: str, config: RunConfig) -> TrainingRun:
    """The group's run, at its end."""
    run = TrainingRun(folder / group)
    if not (run.folder / "config.json").exists():
        run = create_run(folder, config, group)
    elif run.config() != config:
        raise RunError(f"{run.folder} was trained with other settings. Give this table another --name.")
    if run.summary().state not in ("finished", "failed"):
        start_worker(run).wait()
    summary = run.summary()
    if summary.state != "finished":
        raise RunError(
            f"{group}: training is {summary.state}. {summary.reason} See {run.log}; the same command goes on."
        )
    return run


def _group_result(run: TrainingRun, config: RunConfig, episodes: int) -> GroupResult:
    """The run's policy on all cases; tested once, then read."""
    file = run.folder / f"tested-{episodes}.json"
    if file.exists():
        stored: dict[str, Any] = json.loads(file.read_bytes())
    else:
        evaluator = Evaluator(config.choice.resolve())
        result = evaluator.test(run.policy(), episodes, derive_seed(config.seed, "crosstable"))
        stored = {case.case: case.share for case in result.cases}
        if result.is_pair:
            stored[ADJACENCY_KEY] = {case.case: case.adjacency for case in result.cases}
        write_atomically(file, json.dumps(stored).encode())
    summary, adjacency = run.summary(), stored.pop(ADJACENCY_KEY, {})
    return GroupResult(run.name, summary.steps, summary.seconds, stored, adjacency)


ADJACENCY_KEY: Final = "adjacency by rays"
"""In the file of a test, beside its cases."""


def format_crosstable(columns: Sequence[GroupResult], compare: Mapping[str, float]) -> list[str]:
    """An aligned table: a row for each case tested on; means, and below them ``compare``, the means of the dissertation for
    this task, by group."""
    cases = list(columns[0].shares)
    width = max(len("dissertation"), *(len(case) for case in cases))
    wide = [max(9, len(column.group)) for column in columns]

    def row(head: str, cells: Sequence[str]) -> str:
        return "  ".join([f"{head:{width}}", *(f"{cell:>{w}}" for cell, w in zip(cells, wide, strict=True))])

    rows = [row("tested on", [column.group for column in columns])]
    rows += [row(case, [f"{column.shares[case]:.3f}" for column in columns]) for case in cases]
    rows.append(row("mean", [f"{column.mean:.3f}" for column in columns]))
    rows.append(row("spread", [f"{column.spread:.3f}" for column in columns]))
    rows.append(row("steps", [f"{column.steps:,}" for column in columns]))
    rows.append(row("seconds", [f"{column.seconds:.0f}" for column in columns]))
    if any(column.group in compare for column in columns):
        means = [f"{compare[column.group]:.3f}" if column.group in compare else "" for column in columns]
        rows.append(row("dissertation", means))
    if all(column.adjacency for column in columns):
        rows += ["", "side by side, as rays tell: the share of an episode's steps (equations 4.7 to 4.9)"]
        rows += [row(case, [f"{column.adjacency[case]:.3f}" for column in columns]) for case in cases]
        rows.append(row("mean", [f"{np.mean([*column.adjacency.values()]):.3f}" for column in columns]))
    return rows
