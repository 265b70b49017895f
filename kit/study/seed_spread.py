"""How recorded agents of different seeds differ, and which cells lie below the printed number."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from statistics import fmean, pstdev, stdev
from typing import Final

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.study.printed_tables import (
    POTENTIAL_FIELDS,
    SUCCESS,
    PrintedTable,
)
from kit.study.recorded_results import RecordedCell, RecordedResult, RecordedTest
from kit.study.result_logs import log_name
from kit.study.study_variants import VARIANT_NAMES, StudyVariant

SPREAD_NOTE: Final = (
    "The dissertation trained one agent of each kind; the only spread it prints is the SD of an agent over the cases. "
    "`mean`, `low` and `high` are of the seeds' means over the cases, `SD seeds` is theirs (n - 1). `in SD`: "
    "whether our mean differs from the printed one by no more than the printed SD. `between`: whether the printed mean lies "
    "between our low and our high. All seeds from 0 on are in it."
)


@dataclass(frozen=True, slots=True)
class SeedMeans:
    """The mean success of each seed's agents over all cases tested, in the order of the seeds."""

    values: tuple[float, ...]

    @property
    def mean(self) -> float:
        return fmean(self.values)

    @property
    def sd(self) -> float:
        """Sample standard deviation; NaN of one seed."""
        return stdev(self.values) if len(self.values) > 1 else math.nan


def seed_means(table: PrintedTable, result: RecordedResult, column: str) -> SeedMeans | None:
    """Returns the means of a column of success rates: over the table's cases, or those that each agent was trained on. None
    if no seed has been tested on all of them."""
    place = table.columns.index(column)
    groups = table.row_groups or table.groups[place : place + 1]
    if table.measures[place] != SUCCESS or POTENTIAL_FIELDS in groups:
        return None
    by_seed: dict[int, list[RecordedTest]] = {}
    for test in sorted(result.tests, key=lambda test: test.seed):
        if test.group in groups:
            by_seed.setdefault(test.seed, []).append(test)
    means = tuple(
        fmean(
            test.reached[case] / test.episodes
            for test in tests
            for case in (table.case_cells(column) or test.own_cases)
        )
        for tests in by_seed.values()
        if len(tests) == len(groups)
    )
    return SeedMeans(means) if means else None


def spread_table(table: PrintedTable, result: RecordedResult, variant: StudyVariant) -> Table | None:
    """Each agent's printed mean and SD beside the seeds' means; None unless there are several seeds of one."""
    rows: list[tuple[Cell, ...]] = []
    for column in table.columns if table.cases else ():
        means = seed_means(table, result, column)
        if means is None or len(means.values) < 2:
            continue
        printed = list(table.case_cells(column).values())
        mean, sd = fmean(printed), pstdev(printed)
        low, high = min(means.values), max(means.values)
        is_near = "yes" if abs(means.mean - mean) <= sd else "no"
        place = "yes" if low <= mean <= high else "ours above" if low > mean else "ours below"
        rows.append((column, mean, sd, len(means.values), means.mean, low, high, means.sd, is_near, place))
    if not rows:
        return None
    heads = ("printed", "SD", "seeds", "mean", "low", "high", "SD seeds")
    columns = (
        Column("agent", CellStyle.TEXT),
        *(Column(head, decimals=3) for head in heads),
        Column("in SD", CellStyle.TEXT),
        Column("between", CellStyle.TEXT),
    )
    identity = f"table-{log_name(table.id, variant).replace('.', '-')}-means"
    title = f"Means over the cases, printed and by seed: {VARIANT_NAMES[variant]}"
    return Table(identity, title, columns, tuple(rows), note=SPREAD_NOTE)


@dataclass(frozen=True, slots=True)
class CellBelow:
    """A recorded cell whose 95 % interval lies below the printed number: a failure, which stays one."""

    table: str
    row: str
    column: str
    printed: float
    value: float
    high: float


def cells_below(table: PrintedTable, cells: Mapping[tuple[str, str], RecordedCell]) -> Iterator[CellBelow]:
    """Returns the cells in the table's order."""
    for (row, column), cell in cells.items():
        printed = table.cell(row, column)
        if cell.interval is not None and cell.interval.high < printed:
            yield CellBelow(table.id, row, column, printed, cell.value, cell.interval.high)
