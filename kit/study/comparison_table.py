"""A printed table with what was recorded below each printed row."""

from __future__ import annotations

import math
from collections.abc import Mapping

from kit.document.blocks import (
    Cell,
    CellStyle,
    Column,
    Table,
)
from kit.study.printed_tables import (
    STEPS,
    PrintedTable,
)
from kit.study.recorded_results import RecordedCell
from kit.study.study_variants import VARIANT_NAMES, StudyVariant

RecordedCells = Mapping[tuple[str, str], RecordedCell]
"""Cells by row and column of a printed table."""


def comparison_table(table: PrintedTable, cells: Mapping[StudyVariant, RecordedCells]) -> Table:
    identity = f"table-{table.id.replace('.', '-')}"
    is_compared = any(cells.values())
    columns = tuple(
        Column(title, decimals=max(decimals, 3) if is_compared and decimals else decimals)
        for title, decimals in zip(table.columns, table.decimals, strict=True)
    )
    label = Column("", CellStyle.TEXT)
    if not is_compared:
        rows = tuple((row, *_printed_cells(table, row)) for row in table.rows)
        return Table(identity, "As printed", (label, *columns), rows)
    lines: list[tuple[Cell, ...]] = []
    for row in table.rows:
        lines.append((row, "printed", *_printed_cells(table, row)))
        for variant, found in cells.items():
            lines += _recorded_lines(table, row, VARIANT_NAMES[variant], found)
    return Table(
        identity,
        "As printed, and ours",
        (label, label, *columns),
        tuple(lines),
        note="at least, at most: the 95 % interval of the line above. episodes: over which an adjacency is taken, all of which "
        "reached the target. differs: from the printed number.",
        grouped=True,
    )


def _recorded_lines(table: PrintedTable, row: str, name: str, cells: RecordedCells) -> list[tuple[Cell, ...]]:
    """The recorded cells of a row, their intervals, and what differs from the printed ones."""
    ours = [cells.get((row, column)) for column in table.columns]
    if not any(ours):
        return []
    intervals = [each.interval if each else None for each in ours]
    lines: list[tuple[Cell, ...]] = [(row, name, *(_cell_number(each) for each in ours))]
    if any(intervals):
        lines.append((row, "at least", *(each.low if each else None for each in intervals)))
        lines.append((row, "at most", *(each.high if each else None for each in intervals)))
    counts = [each.episodes if each else None for each in ours]
    if any(counts):
        lines.append((row, "episodes", *counts))
    differences = [
        _cell_number(each, printed) if each and not math.isnan(printed) else None
        for each, printed in zip(ours, table.rows[row], strict=True)
    ]
    lines.append((row, "differs", *differences))
    return lines


def _cell_number(cell: RecordedCell | None, printed: float = 0.0) -> Cell:
    """The number, less a printed one; steps are whole."""
    if cell is None:
        return None
    number = cell.value - printed
    return round(number) if cell.measure == STEPS else number


def _printed_cells(table: PrintedTable, row: str) -> tuple[Cell, ...]:
    """Whole numbers without a point."""
    return tuple(
        int(number) if not decimals and not math.isnan(number) else number
        for number, decimals in zip(table.rows[row], table.decimals, strict=True)
    )
