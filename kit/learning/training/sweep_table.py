"""A sweep's results as a table: a row per setting, over its seeds."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import fmean, median

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.learning.policies.confidence_intervals import wilson_interval
from kit.learning.training.training import resolve_preset
from kit.learning.training.training_sweep import SweepEntry, SweepGroup, SweepResult, TrainingSweep
from kit.plain_text import without_formula

DEFAULT_GOAL = 0.9
"""A seed has learned where its worst case succeeds this often, if the task does not say."""
CSV_HEADER = (
    "task",
    "cases",
    "algorithm",
    "preset",
    "reward",
    "settings",
    "seed",
    "steps",
    "seconds",
    "mean",
    "worst",
    "worst_case",
    "reached",
    "episodes",
    "problem",
)


@dataclass(frozen=True, slots=True)
class SweepRow:
    """Trainings that differ in their seeds alone."""

    group: SweepGroup
    seeds: int
    results: tuple[SweepResult, ...]
    """Results of the trainings that have one."""
    goal: float
    most_steps: int
    """Steps after which a training ends in any case."""

    @property
    def learned(self) -> int:
        """How many reach the goal in their worst case."""
        return sum(result.worst >= self.goal for result in self.results)

    @property
    def cost(self) -> float:
        """Steps to learn, mean of the seeds; infinite until all have a result.

        A seed that has not learned counts the most steps of its training, and as many again for its share of failures.
        """
        if len(self.results) < self.seeds:
            return math.inf
        return fmean(
            result.steps if result.worst >= self.goal else self.most_steps * (2.0 - result.mean)
            for result in self.results
        )


def sweep_rows(sweep: TrainingSweep, goal: float | None = None) -> tuple[SweepRow, ...]:
    """One row for each combination. ``goal``: by default the task's ``success``, else 0.9."""
    groups: dict[SweepGroup, list[SweepEntry]] = {}
    for entry in sweep.entries():
        groups.setdefault(entry.group, []).append(entry)
    return tuple(_table_row(sweep, group, entries, goal) for group, entries in groups.items())


def _table_row(
    sweep: TrainingSweep, group: SweepGroup, entries: list[SweepEntry], goal: float | None
) -> SweepRow:
    config = entries[0].config
    goal = goal or config.choice.resolve().success or DEFAULT_GOAL
    results = [result for entry in entries if (result := sweep.result(entry.key)) and not result.problem]
    return SweepRow(group, len(entries), tuple(results), goal, resolve_preset(config).steps)


def sweep_table(rows: Sequence[SweepRow]) -> Table:
    """What differs among the rows, how many seeds have learned with the 95 % interval of the true share (Wilson), success over
    all seeds, the worst case of all, medians of steps and minutes."""
    names = ("task", "cases", "algorithm", "preset", "reward", "settings")
    shown = [n for n in range(len(names)) if n == 0 or len({row.group[n] for row in rows}) > 1]
    columns = [
        *(Column(names[n], CellStyle.TEXT) for n in shown),
        Column("learned"),
        Column("95 % interval"),
        Column("success", decimals=3),
        Column("worst", decimals=3),
        Column("steps"),
        Column("minutes", decimals=2, is_optional=True),
    ]
    own = tuple(dict.fromkeys(name for row in rows for each in row.results for name in each.metrics))
    columns += [Column(name, decimals=2) for name in own]
    if any(len(row.results) < row.seeds for row in rows):
        columns.append(Column("missing"))
    cells = tuple((*(row.group[n] for n in shown), *_measure_cells(row, own))[: len(columns)] for row in rows)
    goals = " or ".join(f"{goal:g}" for goal in sorted({row.goal for row in rows}))
    note = f"learned: seeds whose worst case has a success rate of {goals} or more."
    return Table("sweep", "", tuple(columns), cells, note, is_ruled=False)


def _measure_cells(row: SweepRow, metrics: Sequence[str]) -> tuple[Cell, ...]:
    results, missing = row.results, row.seeds - len(row.results)
    if not results:
        return (f"0 of {row.seeds}", *[None] * (5 + len(metrics)), missing)
    return (
        f"{row.learned} of {len(results)}",
        wilson_interval(row.learned, len(results)),
        fmean(each.mean for each in results),
        min(each.worst for each in results),
        f"{median(each.steps for each in results):,.0f}",
        median(each.seconds for each in results) / 60,
        *(fmean(each.metrics.get(name, math.nan) for each in results) for name in metrics),
        missing or "",
    )


def sweep_table_csv(sweep: TrainingSweep) -> str:
    """A table for other programs: a row for each training."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    own = tuple(dict.fromkeys(name for _, result in _tested_entries(sweep) for name in result.metrics))
    writer.writerow((*CSV_HEADER, *own))
    for entry, result in _tested_entries(sweep):
        worst_case = without_formula(result.worst_case)
        found = (result.steps, result.seconds, result.mean, result.worst, worst_case)
        writer.writerow(
            (
                *(without_formula(str(each)) for each in entry.group),
                entry.config.seed,
                *found,
                result.reached,
                result.episodes,
                without_formula(result.problem),
                *(result.metrics.get(name, "") for name in own),
            )
        )
    return text.getvalue()


def problems(sweep: TrainingSweep) -> list[str]:
    """A line for each training that has failed."""
    return [
        f"{', '.join(entry.group)}, seed {entry.config.seed}: {result.problem}"
        for entry, result in _tested_entries(sweep)
        if result.problem
    ]


def _tested_entries(sweep: TrainingSweep) -> Iterator[tuple[SweepEntry, SweepResult]]:
    for entry in sweep.entries():
        result = sweep.result(entry.key)
        if result is not None:
            yield entry, result
