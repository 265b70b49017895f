"""The summary's table of trainings that were run again: how many seeds reached the printed accuracy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.study.printed_tables import SUCCESS, PrintedTable, printed_table
from kit.study.result_logs import find_recorded_results
from kit.study.trained_seeds import TrainedSeeds

TRAINED_AGAIN: Final = ("3.3", "4.1", "4.2", "4.5", "5.2")
"""Tables that print accuracies of trainings; 4.5 repeats 4.4."""


def trained_again_table() -> Table:
    """For each kind of training: how many seeds reached an accuracy of 0.8, beside the printed one."""
    columns = (
        Column("Trained again by", CellStyle.TEXT),
        Column("settings", CellStyle.TEXT),
        *(
            Column(title)
            for title in ("printed", "seeds at 0.8", "best tests", "steps", "at most", "without limit")
        ),
    )
    rows: list[tuple[Cell, ...]] = []
    for number in TRAINED_AGAIN:
        table = printed_table(number)
        results = find_recorded_results(table, None)
        for label, group, printed in _trainings(table):
            ours, other = (
                TrainedSeeds.of(table, results.get(variant), group) for variant in ("seed", "no-limit")
            )
            if not ours.planned:
                continue
            bests = [session.share for session in ours.best_sessions]
            rows.append(
                (
                    f"{number}{label}",
                    table.settings_of,
                    f"{printed:.2f}",
                    _seeds_text(ours),
                    _range_text(bests, "{:.2f}"),
                    _range_text(ours.steps_to_goal, "{:,}"),
                    f"{results['seed'].settings.most_steps:,}" if ours.tests else None,
                    _seeds_text(other, with_steps=True) if other.tests else None,
                )
            )
    return Table("trained-again", "", columns, tuple(rows))


def _trainings(table: PrintedTable) -> Iterator[tuple[str, str, float]]:
    """Each kind of training that a table prints: what it is called there, the group of cases, the printed accuracy."""
    for place, (column, measure) in enumerate(zip(table.columns, table.measures, strict=True)):
        if measure != SUCCESS:
            continue
        if table.row_groups:
            for row, group in zip(table.rows, table.row_groups, strict=False):
                yield (f", {row}" if len(table.row_groups) > 1 else ""), group, table.cell(row, column)
        else:
            rows = [table.cell(row, column) for row in table.rows_without_means]
            name = column.removesuffix("acc").strip()
            yield (f", {name}" if name else ""), table.groups[place], sum(rows) / len(rows)


def _seeds_text(seeds: TrainedSeeds, *, with_steps: bool = False) -> str:
    """``2 of 5``, with the steps that these took; and how many are still to be trained."""
    missing = seeds.planned - len(seeds.tests)
    if not seeds.tests:  # "0 of 0" would be read as a failure
        return f"{missing} to be trained"
    told = f"{seeds.reached} of {len(seeds.tests)}"
    if with_steps and seeds.steps_to_goal:
        told += f" ({_range_text(seeds.steps_to_goal, '{:,}')})"
    return f"{told}, {missing} unfinished" if missing else told


def _range_text(values: Sequence[float], form: str) -> str | None:
    """The lowest and the highest."""
    if not values:
        return None
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low}-{high}"
