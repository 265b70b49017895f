"""How agents from different seeds differ, beside what the dissertation printed of one; and the cells that lie below the print."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from statistics import fmean, pstdev, stdev
from typing import Final

from kit.school.report.document import CellStyle, ReportTable, TableCell, TableColumn
from kit.study.printed_tables import POTENTIAL_FIELDS, SUCCESS, PrintedTable
from kit.study.recorded_results import RecordedCell, RecordedResult, StudyVariant

SPREAD_NOTE: Final = (
    "The dissertation trained one agent of each kind; the only spread it prints is the SD of an agent over the cases. "
    "`mean`, `low` and `high` are of the seeds' means over the cases, `SD seeds` is theirs (n - 1). `in SD`: "
    "whether our mean differs from the printed one by no more than the printed SD. `between`: whether the printed mean lies "
    "between our low and our high. All seeds from 0 on are in it."
)


@dataclass(frozen=True, slots=True)
class SeedMeans:
    """The mean over all cases of each seed's agent, in the order of the seeds."""

    values: tuple[float, ...]

    @property
    def mean(self) -> float:
        return fmean(self.values)

    @property
    def sd(self) -> float:
        """Sample standard deviation; NaN of one seed."""
        return stdev(self.values) if len(self.values) > 1 else math.nan


def seed_means(table: PrintedTable, result: RecordedResult, column: str) -> SeedMeans | None:
    """Of a column of success shares by case; None if no agent of it was tested."""
    place = table.columns.index(column)
    if not table.cases or table.measures[place] != SUCCESS or table.groups[place] == POTENTIAL_FIELDS:
        return None
    cases = table.case_cells(column)
    tests = sorted(result.tests_of(table.groups[place]), key=lambda test: test.seed)
    means = tuple(fmean(test.reached[case] / test.episodes for case in cases) for test in tests)
    return SeedMeans(means) if means else None


def spread_table(table: PrintedTable, result: RecordedResult, variant: StudyVariant) -> ReportTable | None:
    """Each agent's printed mean and SD beside the seeds' means; None unless there are several seeds of one."""
    rows: list[tuple[TableCell, ...]] = []
    for column in table.columns:
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
        TableColumn("agent", CellStyle.TEXT),
        *(TableColumn(head, decimals=3) for head in heads),
        TableColumn("in SD", CellStyle.TEXT),
        TableColumn("between", CellStyle.TEXT),
    )
    identity = f"table-{table.id.replace('.', '-')}-seeds" + ("-kit" if variant == "kit" else "")
    title = f"Means over the cases, printed and by seed: {'kit' if variant == 'kit' else 'ours'}"
    return ReportTable(identity, title, columns, tuple(rows), note=SPREAD_NOTE)


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
    """In the table's order."""
    for (row, column), cell in cells.items():
        printed = table.cell(row, column)
        if cell.interval is not None and cell.interval.high < printed:
            yield CellBelow(table.id, row, column, printed, cell.value, cell.interval.high)
