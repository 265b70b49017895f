"""The study's summary, which README tells too: three tables, the finding, and the command under each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

from kit.document.blocks import (
    Block,
    Cell,
    CellStyle,
    Chapter,
    Column,
    Table,
    Text,
)
from kit.document.markdown import table_to_markdown
from kit.study.author_agents import read_author_agents
from kit.study.comparison_table import RecordedCells
from kit.study.printed_tables import (
    ADJACENCY,
    STEPS,
    SUCCESS,
    PrintedTable,
    printed_table,
)
from kit.study.recorded_results import RecordedResult
from kit.study.result_logs import find_recorded_results
from kit.study.seed_spread import seed_means
from kit.study.trained_seeds import TrainedSeeds


def summary_chapter() -> Chapter:
    """What README tells, too: three tables, the finding, and the command under each."""
    blocks: list[Block] = []
    for table, command in summary_tables():
        blocks += [table, Text(command)]
    return Chapter("summary", "Summary", (*blocks, Text(FINDING)))


FINDING: Final = (
    "Why 4.1 and 4.2 rarely come out: the author's library takes values above 500 for equal. Side by side pays 10 a step, so good "
    "actions soon pass 500; then it explores by chance, and the values feed on each other without end. The prints are the best "
    "of up to 100 tests; printed adjacency largely measures how late ROS delivered commands."
)


def summary_lines() -> list[str]:
    """What README tells of the study, as Markdown: tables, a sentence below each, and the finding."""
    lines: list[str] = []
    for table, sentence in summary_tables():
        rows = table_to_markdown(replace(table, note=""))
        lines += [line.replace(" | ", "|").replace("| ", "|").replace(" |", "|") for line in rows]
        lines += ["", sentence, ""]
    return [*lines, FINDING]


def summary_tables() -> tuple[tuple[Table, str], ...]:
    """Each with the sentence below it."""
    return (
        (
            _author_summary(),
            (
                "Recorded outside the kit, from his published networks; adjacency: share of steps side by side by rays. All: "
                "`kit study author`."
            ),
        ),
        (
            trained_again_table(),
            (
                "Seeds 0, 1, ...; each ends with a test of 0.8. Again: `kit study 4.1 --again --seeds 5`, or with `--no-limit`; values: "
                "`kit study clip`."
            ),
        ),
        (
            compared_means_table(),
            (
                "Means over cases (lowest-highest seed); adjacency of successful episodes. Again: `kit study 4.6 --again --kit`; all "
                "numbers checked: `kit study --check`."
            ),
        ),
    )


def _author_summary() -> Table:
    """What the published agents reach in the kit's own simulator."""
    titles = ("jitter [s]", "printed", "here", "adjacency", "here")
    columns = (
        Column("The author's agents", CellStyle.TEXT),
        *(Column(title, decimals=2) for title in titles),
    )
    rows: list[tuple[Cell, ...]] = [
        (
            f"{each.table}, {each.agent.partition(' (')[0].replace('_', ' ')}",
            *(each.jitter_s, each.printed_success, each.success, each.printed_adjacency, each.adjacency),
        )
        for each in read_author_agents()
        if each.where.startswith("full simulator")
    ]
    return Table("author-summary", "", columns, tuple(rows))


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


TRAINED_AGAIN: Final = ("3.3", "4.1", "4.2", "4.5", "5.2")
"""Tables that print accuracies of trainings; 4.5 repeats 4.4."""


def _trainings(table: PrintedTable) -> Iterator[tuple[str, str, float]]:
    """Each kind of training that a table prints: what it is called there, the group of cases, the printed accuracy."""
    for place, (column, measure) in enumerate(zip(table.columns, table.measures, strict=True)):
        if measure != SUCCESS:
            continue
        if table.row_groups:
            for row, group in zip(table.rows, table.row_groups, strict=False):
                yield (f", {row}" if len(table.row_groups) > 1 else ""), group, table.cell(row, column)
        else:
            rows = [table.cell(row, column) for row in _own_rows(table)]
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
            printed = {row: table.cell(row, column) for row in _own_rows(table)}
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


COMPARED_MEANS: Final = ("3.5", "4.6", "5.2")
"""The tables of agents on fresh episodes."""


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


def _own_rows(table: PrintedTable) -> list[str]:
    """Returns the table's rows without those of means."""
    return list(table.rows)[: len(table.cases) or table.attempts]


def _column_mean(values: dict[str, float], printed: dict[str, float] | None = None) -> Cell:
    """The mean of what is a number; None if a number is missing where ``printed`` has one."""
    expected = [row for row, value in (printed or values).items() if value == value]
    numbers = [values[row] for row in expected if row in values]
    if not numbers or len(numbers) < len(expected):
        return None
    return sum(numbers) / len(numbers)
