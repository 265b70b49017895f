"""Checks that the document and README's tables follow from the logs, and that every row compares what can be compared."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path
from typing import Final

from kit.learning.tasks.catalogue import find_task
from kit.study.printed_tables import (
    ADJACENCY,
    ADJACENCY_BY_POSES,
    SUMMARY_ROWS,
    PrintedTable,
    study_chapters,
)
from kit.study.recorded_results import Results
from kit.study.result_logs import find_recorded_results
from kit.study.study_document import DOCUMENT, recorded_study_document
from kit.study.study_summary import summary_lines
from kit.study.study_variants import VARIANT_NAMES
from kit.study.task_comparison import test_differences

README: Final = Path(__file__).parents[2] / "README.md"
"""There only where the kit runs from its source."""


def check_document() -> list[str]:
    """What differs between the document that comes with the kit, with README's tables, and what the logs give; and rows that
    compare what cannot be compared; a line each."""
    told = DOCUMENT.read_text(encoding="utf-8") if DOCUMENT.exists() else ""
    found = [
        f"{DOCUMENT.name}, line {number}: {there or 'nothing'!r}, computed {computed or 'nothing'!r}"
        for number, (there, computed) in enumerate(
            zip_longest(told.splitlines(), recorded_study_document().splitlines()), start=1
        )
        if there != computed
    ]
    if README.exists():
        lines = set(README.read_text(encoding="utf-8").splitlines())
        found += [f"README.md lacks {line!r}" for line in summary_lines() if line and line not in lines]
    for chapter in study_chapters():
        for table in chapter.tables:
            found += incomparable_rows(table, find_recorded_results(table, None))
    return found


def incomparable_rows(table: PrintedTable, results: Results) -> list[str]:
    """What is wrong with a table's comparisons: agents that were tested on another task than the printed ones, and adjacency
    without an episode that reached the target."""
    found = []
    for variant, result in results.items():
        name = f"Table {table.id}, {VARIANT_NAMES[variant]}"
        cells = result.cells(table)
        shown = bool(cells) or (table.prints_best_test and variant != "kit")
        if shown and variant != "kit" and result.settings.task != table.repeat_task:
            found.append(
                f"{name}: {result.file.name} is of {result.settings.task}, not of {table.repeat_task}"
            )
        elif shown and result.settings.task and table.repeat_task:
            differences = test_differences(find_task(result.settings.task), find_task(table.repeat_task))
            found += [
                f"{name}: {result.file.name} is of another task than the print; {each}"
                for each in differences
            ]
        found += [
            f"{name}: an adjacency in {row}, {column} is of no episode that reached the target"
            for (row, column), cell in cells.items()
            if cell.measure in (ADJACENCY, ADJACENCY_BY_POSES)
            and row not in SUMMARY_ROWS
            and not cell.episodes
        ]
    return found
