"""The dissertation's tables and figures as a report: as printed, what was recorded beside it, and what shows the same here."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from kit.learning.training.run_table import format_seconds
from kit.school.report.document import (
    CellStyle,
    ReportBlock,
    ReportChapter,
    ReportTable,
    ReportText,
    ReportWarning,
    TableCell,
    TableColumn,
)
from kit.study.printed_tables import Misprint, PrintedFigure, PrintedTable, StudyChapter
from kit.study.recorded_results import RecordedCell, RecordedResult

RecordedCells = Mapping[tuple[str, str], RecordedCell]
"""By row and column of a printed table."""


def overview_chapter(
    chapter: StudyChapter, items: Sequence[tuple[str, str, str]], note: str
) -> ReportChapter:
    """A list of ``items``: the table or figure, its title, and what there is of ours.

    ``note`` stands below it.
    """
    heads = ("number", "what it shows", "ours")
    columns = tuple(TableColumn(head, CellStyle.TEXT) for head in heads)
    title = f"Chapter {chapter.number}. {chapter.title}"
    return ReportChapter(
        f"chapter-{chapter.number}",
        title,
        (ReportTable(f"chapter-{chapter.number}", "", columns, tuple(items)), ReportText(note)),
    )


def table_chapter(
    table: PrintedTable,
    misprints: Sequence[Misprint],
    recorded: RecordedResult | None,
    seconds: tuple[float, float] | None,
) -> ReportChapter:
    """A printed table with its settings and slips; below each printed row what was recorded, if anything was.

    ``seconds``: how long it would take to train its agents again, with the dissertation's steps and at most; None if the kit
    cannot do that by one command.
    """
    cells = recorded.cells(table) if recorded is not None else {}
    blocks: list[ReportBlock] = [ReportText(text) for text in (f"Section {table.section}.", *table.settings)]
    blocks.append(_comparison_table(table, cells))
    if recorded is not None:
        blocks += _recorded_blocks(table, recorded, cells)
    blocks += [ReportText(f"Slip: {each.why}{_right_values(each)}") for each in misprints]
    if recorded is None:
        blocks.append(ReportText(_how_to_run(table, seconds)))
    return ReportChapter(f"table-{table.id}", f"Table {table.id}. {table.title}", tuple(blocks))


def figure_chapter(figure: PrintedFigure, plots: Sequence[ReportBlock]) -> ReportChapter:
    """``plots``: ours, from the raw answers."""
    blocks = [ReportText(f"Section {figure.section}."), *plots]
    if figure.run:
        blocks.append(ReportText(f"No recorded result; run it with `{figure.run}`."))
    if figure.missing:
        blocks.append(ReportText(f"Missing: {figure.missing}"))
    return ReportChapter(f"figure-{figure.id}", f"Figure {figure.id}. {figure.title}", tuple(blocks))


def table_status(recorded: RecordedResult | None, table: PrintedTable) -> str:
    """What there is of ours, in the list of all tables."""
    if recorded is not None:
        agents = sum(each.group in table.groups for each in recorded.tests)
        return f"recorded: {agents} agent{'s' if agents != 1 else ''}"
    if table.repeat_task:
        return "none; --again"
    return "none" if table.run else "-"


def _comparison_table(table: PrintedTable, cells: RecordedCells) -> ReportTable:
    identity = f"table-{table.id.replace('.', '-')}"
    columns = tuple(
        TableColumn(title, decimals=max(decimals, 3) if cells and decimals else decimals)
        for title, decimals in zip(table.columns, table.decimals, strict=True)
    )
    label = TableColumn("", CellStyle.TEXT)
    if not cells:
        rows = tuple((row, *_printed_cells(table, row)) for row in table.rows)
        return ReportTable(identity, "As printed", (label, *columns), rows)
    lines: list[tuple[TableCell, ...]] = []
    for row in table.rows:
        ours = [cells.get((row, column)) for column in table.columns]
        lines.append((row, "printed", *_printed_cells(table, row)))
        if any(ours):
            intervals = [each.interval if each else None for each in ours]
            lines.append((row, "ours", *(each.value if each else None for each in ours)))
            if any(intervals):
                lines.append((row, "95 % from", *(each.low if each else None for each in intervals)))
                lines.append((row, "95 % to", *(each.high if each else None for each in intervals)))
            differences = [
                each.value - printed if each and not math.isnan(printed) else None
                for each, printed in zip(ours, table.rows[row], strict=True)
            ]
            lines.append((row, "difference", *differences))
    return ReportTable(identity, "As printed, and ours", (label, label, *columns), tuple(lines), grouped=True)


def _printed_cells(table: PrintedTable, row: str) -> tuple[TableCell, ...]:
    """Whole numbers without a point."""
    return tuple(
        int(number) if not decimals and not math.isnan(number) else number
        for number, decimals in zip(table.rows[row], table.decimals, strict=True)
    )


def _recorded_blocks(
    table: PrintedTable, recorded: RecordedResult, cells: RecordedCells
) -> list[ReportBlock]:
    """How ours were made, and every cell whose interval lies below the printed number."""
    settings = recorded.settings
    versions = ", ".join(f"{name} {number}" for name, number in settings.versions.items())
    blocks: list[ReportBlock] = [
        ReportText(
            f"Ours: {settings.task}, {settings.algorithm}, preset {settings.preset}, {settings.episodes} episodes of each case. "
            "An interval is Wilson's, over the episodes of all seeds together: how agents of different seeds differ is "
            f"not in it. Adjacency is by rays. {versions}. {recorded.file}"
        )
    ]
    for group in table.trained_groups:
        told = [
            f"seed {each.seed}: {each.steps:,} steps in {format_seconds(each.seconds)}"
            for each in recorded.tests_of(group)
        ]
        blocks.append(ReportText(f"Trained on {group}: {'; '.join(told) or 'no agent yet'}."))
    below = [
        f"{row}, {column}: {table.cell(row, column):g} printed, at most {cell.interval.high:.3f} ours"
        for (row, column), cell in cells.items()
        if cell.interval is not None and cell.interval.high < table.cell(row, column)
    ]
    if below:
        blocks.append(ReportWarning(f"Below the printed number, with 95 % confidence: {'; '.join(below)}."))
    return blocks


def _right_values(misprint: Misprint) -> str:
    found = "; ".join(f"{cell.row}, {cell.column}: {cell.ours:g}" for cell in misprint.cells)
    return f" Right: {found}." if found else ""


def duration_text(seconds: tuple[float, float]) -> str:
    """How long trainings take that end as soon as they are good enough."""
    expected, most = map(format_seconds, seconds)
    return f"about {expected} if training takes as many steps as the dissertation's did, at most about {most}"


def _how_to_run(table: PrintedTable, seconds: tuple[float, float] | None) -> str:
    """What makes a result where none is recorded."""
    parts = []
    if seconds is not None:
        parts.append(
            f"No recorded result. `kit study {table.id} --again` makes one: for one seed {duration_text(seconds)}."
        )
    elif table.run:
        parts.append("No recorded result.")
    if table.run:
        parts.append(f"By hand: `{table.run}`.")
    if table.missing:
        parts.append(table.missing)
    return " ".join(parts) or "Nothing to run."
