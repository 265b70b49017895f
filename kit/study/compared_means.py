"""The summary's table of means over cases: printed, by the dissertation's settings, and by the kit's."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.study.comparison_table import RecordedCells
from kit.study.printed_tables import ADJACENCY, STEPS, SUCCESS, PrintedTable, printed_table
from kit.study.recorded_results import RecordedResult
from kit.study.result_logs import find_recorded_results
from kit.study.seed_spread import seed_means

COMPARED_MEANS: Final = ("3.5", "4.6", "5.2")
"""The tables of agents on fresh episodes."""


def compared_means_table() -> Table:
    """Means over cases: printed, by agents of the dissertation's settings, and by the kit's own preset; where there are any."""
    rows: list[tuple[Cell, ...]] = []
    for number in COMPARED_MEANS:
        table = printed_table(number)
        results = {
            name: result for name, result in find_recorded_results(table, None).items() if name != "no-limit"
        }
        cells = {name: result.cells(table) for name, result in results.items()}
        for column, measure in zip(table.columns, table.measures, strict=True):
            if measure == STEPS:
                continue
            printed = {row: table.cell(row, column) for row in table.rows_without_means}
            label = f"{number}, {_column_title(column, measure)}".rstrip(", ")
            if measure != SUCCESS:
                told = [
                    row for row in printed if cells and all((row, column) in each for each in cells.values())
                ]
                label += f", {len(told)} of {len(printed)} cases" if len(told) < len(printed) else ""
                printed = {row: printed[row] for row in told}
            ours = [
                _mean_cell(table, results.get(name), cells.get(name, {}), column, printed)
                for name in ("seed", "kit")
            ]
            if any(cell is not None for cell in ours):
                rows.append((label, _column_mean(printed), *ours))
    columns = (
        Column("Compared", CellStyle.TEXT),
        *(Column(title) for title in ("dissertation", "its settings", "the kit's")),
    )
    return Table("compared-means", "", columns, tuple(rows))


def _mean_cell(
    table: PrintedTable,
    result: RecordedResult | None,
    cells: RecordedCells,
    column: str,
    printed: dict[str, float],
) -> Cell:
    """The mean of several seeds with the lowest and the highest; or of one; of an adjacency with its episodes."""
    if (text := _mean_text(table, result, column)) is not None:
        return text
    own = {row: cell for row in printed if (cell := cells.get((row, column))) is not None}
    mean = _column_mean({row: cell.value for row, cell in own.items()}, printed)
    episodes = sum(cell.episodes or 0 for cell in own.values())
    return mean if mean is None or not episodes else f"{mean:.2f} ({episodes:,} episodes)"


def _column_title(column: str, measure: str) -> str:
    """A column's title with the measure, if it is not success, in full."""
    title = column.removesuffix("acc").removesuffix("adj").strip()
    by_rays = "adjacency by rays" if measure == ADJACENCY else measure
    return title if measure == SUCCESS else f"{title} {by_rays}".strip()


def _mean_text(table: PrintedTable, result: RecordedResult | None, column: str) -> str | None:
    """The mean of several seeds with the lowest and the highest of them; None of one."""
    means = seed_means(table, result, column) if result is not None else None
    if means is None or len(means.values) < 2:
        return None
    return f"{means.mean:.2f} ({min(means.values):.2f}-{max(means.values):.2f})"


def _column_mean(values: dict[str, float], printed: dict[str, float] | None = None) -> Cell:
    """The mean of what is a number; None if a number is missing where ``printed`` has one."""
    expected = [row for row, value in (printed or values).items() if value == value]
    numbers = [values[row] for row in expected if row in values]
    if not numbers or len(numbers) < len(expected):
        return None
    return sum(numbers) / len(numbers)
