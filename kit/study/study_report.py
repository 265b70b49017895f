"""The dissertation's tables and figures as a report: as printed, what was recorded beside it, and what shows the same here."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean
from typing import Final

from kit.document.blocks import (
    BarChart,
    Block,
    Caution,
    Cell,
    CellStyle,
    Chapter,
    Column,
    Plot,
    Table,
    Text,
)
from kit.learning.training.run_upkeep import format_seconds
from kit.study.comparison_table import RecordedCells, comparison_table
from kit.study.printed_tables import (
    ADJACENCY,
    ADJACENCY_BY_POSES,
    POTENTIAL_FIELDS,
    STEPS,
    Misprint,
    PrintedFigure,
    PrintedTable,
    StudyChapter,
)
from kit.study.recorded_results import RecordedPath, RecordedResult, RecordedTest, Results, TrainingSession
from kit.study.result_logs import log_name
from kit.study.seed_spread import cells_below, spread_table
from kit.study.seeds_table import seeds_table
from kit.study.study_variants import CONTROLLERS, VARIANT_NAMES, VARIANT_OPTIONS, StudyVariant

VARIANT_TITLES: Final[Mapping[StudyVariant, str]] = {
    "seed": "ours, by the dissertation's settings",
    "no-limit": "no limit, by the dissertation's settings without its limit of values",
    "kit": "kit, by the kit's own preset",
}
Durations = Mapping[StudyVariant, tuple[float, float]]
"""How long it would take to make a result: as expected, and at most [s]."""


def overview_chapter(
    chapter: StudyChapter, items: Sequence[tuple[str, str, str]], notes: Sequence[str]
) -> Chapter:
    """A list of ``items``: the table or figure, its title, and what there is of ours.

    ``notes`` stand below it.
    """
    heads = ("number", "what it shows", "ours")
    columns = tuple(Column(head, CellStyle.TEXT) for head in heads)
    title = f"Chapter {chapter.number}. {chapter.title}"
    return Chapter(
        f"chapter-{chapter.number}",
        title,
        (Table(f"chapter-{chapter.number}", "", columns, tuple(items)), *map(Text, notes)),
    )


def table_chapter(
    table: PrintedTable, misprints: Sequence[Misprint], results: Results, missing: Durations
) -> Chapter:
    """A printed table with its settings and slips; below each printed row what was recorded, if anything was.

    ``missing``: how long it would take to make the results that are not there.
    """
    cells = {variant: result.cells(table) for variant, result in results.items()}
    blocks: list[Block] = [Text(text) for text in (f"Section {table.section}.", *table.settings)]
    blocks.append(comparison_table(table, cells))
    if table.prints_best_test:
        blocks.append(seeds_table(table, results))
    for variant, result in results.items():
        blocks += _recorded_blocks(table, variant, result, cells[variant])
    if any(cells.values()):
        blocks.append(_bar_plot(table, cells))
    blocks += [Text(note) for note in _table_notes(table, cells)]
    blocks += [Text(f"Slip: {each.why}{_right_values(each)}") for each in misprints]
    blocks += [Text(text) for text in _how_to_run(table, missing)]
    return Chapter(f"table-{table.id}", f"Table {table.id}. {table.title}", tuple(blocks))


def figure_chapter(
    figure: PrintedFigure, plots: Sequence[Block], recorded: RecordedResult | None = None
) -> Chapter:
    """``plots``: ours, from the raw answers or from what was ``recorded``."""
    blocks = [*map(Text, (f"Section {figure.section}.", *figure.settings)), *plots]
    if recorded is not None and plots:
        blocks.append(Text(_origin_text(recorded)))
    elif figure.run:
        blocks.append(Text(f"No recorded result; run it with `{figure.run}`."))
    if figure.missing:
        blocks.append(Text(f"Missing: {figure.missing}"))
    title = figure.title if figure.sessions == "values" else f"Figure {figure.id}. {figure.title}"
    return Chapter(f"figure-{figure.id}", title, tuple(blocks))


def paths_title(figure: PrintedFigure, case: str, ways: Sequence[RecordedPath]) -> str:
    """What a picture of ways shows, and how each ended."""
    ends = [way.outcome for way in ways]
    who = "potential fields" if figure.group == POTENTIAL_FIELDS else f"trained on {figure.group}, seed 0"
    told = ", ".join(f"{ends.count(each)} {each}" for each in dict.fromkeys(ends))
    return f"Figure {figure.id}, ours: {case}, {who}: {told}"


def session_plot(figure: PrintedFigure, test: RecordedTest) -> Plot | None:
    """What the tests during a training came to; None if there were none."""
    if not test.sessions:
        return None
    name = f"figure-{figure.id.replace('.', '-')}"
    title = f"Figure {figure.id}, ours: trained on {test.group}, seed {test.seed}"
    if figure.sessions == "outcomes":
        rows = tuple((f"{each.steps:,} steps", _outcome_shares(each)) for each in test.sessions)
        return BarChart(name, title, ("reached", "collided", "timed out"), rows, 0.0, 1.0)
    values = [
        (each.steps, value)
        for each in test.sessions
        if (value := each.adjacency if figure.sessions == "adjacency" else each.reward) is not None
    ]
    if not values:
        return None
    low, high = min(0.0, *(value for _, value in values)), max(1.0, *(value for _, value in values))
    rows = tuple((f"{steps:,} steps", (value,)) for steps, value in values)
    return BarChart(name, title, (figure.sessions,), rows, low, high)


def _outcome_shares(session: TrainingSession) -> tuple[float, ...]:
    counts = (session.reached, session.collided, session.timed_out)
    return tuple(count / max(1, sum(counts)) for count in counts)


def table_status(results: Results, table: PrintedTable) -> str:
    """Says in the list of all tables which results of the kit's there are."""
    found = []
    for variant, result in results.items():
        tests = [each for each in result.tests if each.group in (*table.groups, *table.row_groups)]
        if tests:
            found.append(f"{VARIANT_NAMES[variant]} {len(tests)}")
    if found:
        return f"recorded: {', '.join(found)}"
    if table.repeat_task or table.results_of or table.has_potential_fields:
        return f"none; {table.results_of or table.id} --again"
    return "none" if table.run else "-"


def _bar_plot(table: PrintedTable, cells: Mapping[StudyVariant, RecordedCells]) -> Plot:
    """Bars: printed shares and ours beside them; where rows are cases, the mean of a column, ours if there is one of each case."""
    rows: list[tuple[str, tuple[float, ...]]] = []
    own = list(table.rows)[: len(table.cases) or None]
    for column in table.columns:
        compared = [row for row in own if _is_share(cells, row, column)]
        printed_rows = [row for row in own if not math.isnan(table.cell(row, column))]
        for part in [printed_rows] if table.cases and compared else [[row] for row in compared]:
            shares = (
                [found[row, column].value for row in part if (row, column) in found]
                for found in cells.values()
            )
            ours = [fmean(each) if each and len(each) == len(part) else math.nan for each in shares]
            if all(map(math.isnan, ours)):
                continue
            label = f"{column}, mean" if table.cases else f"{part[0]}, {column}"
            rows.append((label, (fmean(table.cell(row, column) for row in part), *ours)))
    names = ("printed", *(VARIANT_NAMES[variant] for variant in cells))
    name = f"table-{table.id.replace('.', '-')}-bars"
    return BarChart(name, f"Table {table.id}", names, tuple(rows), 0.0, 1.0)


def _is_share(cells: Mapping[StudyVariant, RecordedCells], row: str, column: str) -> bool:
    """Whether ours are shares there, and there are any."""
    ours = [found[row, column] for found in cells.values() if (row, column) in found]
    return bool(ours) and ours[0].measure != STEPS


def _recorded_blocks(
    table: PrintedTable, variant: StudyVariant, recorded: RecordedResult, cells: RecordedCells
) -> list[Block]:
    """How ours were made, and every cell whose interval lies below the printed number."""
    name = VARIANT_NAMES[variant]
    blocks: list[Block] = [Text(f"{VARIANT_TITLES[variant]}: {_origin_text(recorded)}")]
    groups = table.groups if table.has_potential_fields else (*table.trained_groups, *table.row_groups)
    for group in () if table.prints_best_test and variant != "kit" else dict.fromkeys(groups):
        told = [_test_text(each) for each in recorded.tests_of(group)]
        blocks.append(Text(f"{name}, {group}: {'; '.join(told) or 'no agent yet'}."))
    if table.has_potential_fields and variant in CONTROLLERS:
        blocks.append(Text(f"{name}: where the print has potential fields, `{CONTROLLERS[variant]}` drives."))
        if (sides := _sides_table(table, recorded, variant)) is not None:
            blocks.append(sides)
    if (spread := spread_table(table, recorded, variant)) is not None:
        blocks.append(spread)
    below = [
        f"{each.row}, {each.column}: {each.printed:g} printed, at most {each.high:.3f} {name}"
        for each in cells_below(table, cells)
    ]
    if below:
        blocks.append(
            Caution(
                f"{len(below)} of {sum(cell.interval is not None for cell in cells.values())} cells fail: their 95 % interval "
                f"lies below the printed number. No agent was trained again for it. {'; '.join(below)}."
            )
        )
    return blocks


def _table_notes(table: PrintedTable, cells: Mapping[StudyVariant, RecordedCells]) -> Iterator[str]:
    """What the recorded numbers of a table mean, once for all of them."""
    if any(cell.interval is not None for found in cells.values() for cell in found.values()):
        yield INTERVALS_NOTE
    if any(cells.values()) and {ADJACENCY, ADJACENCY_BY_POSES} & set(table.measures):
        yield ADJACENCY_NOTE


ADJACENCY_NOTE: Final = (
    "Adjacency of agents is by rays, equations 4.7 to 4.9, over the episodes that reached the target; that of controllers is by "
    "poses, 4.2 to 4.6, repaired."
)
INTERVALS_NOTE: Final = (
    "Intervals hold 95 % over the episodes of all seeds together (Wilson's of shares of success, Student's of adjacency): how "
    "agents of different seeds differ is not in them."
)


def _sides_table(table: PrintedTable, recorded: RecordedResult, variant: StudyVariant) -> Table | None:
    """How often a controller's robots were side by side, by both measures; None where only rays were recorded."""
    column = table.column_of(POTENTIAL_FIELDS, ADJACENCY_BY_POSES)
    tests = recorded.tests_of(POTENTIAL_FIELDS)
    if column is None:
        return None
    rows: list[tuple[Cell, ...]] = []
    for row, (_, case) in zip(table.rows, table.cases, strict=False):
        found = [each for each in tests if case in each.by_poses]
        if found:
            rows.append((row, table.cell(row, column), found[0].adjacency[case], found[0].by_poses[case]))
    if not rows:
        return None
    columns = (
        Column("", CellStyle.TEXT),
        *(Column(title) for title in ("printed", "by rays", "by poses")),
    )
    identity = f"table-{log_name(table.id, variant).replace('.', '-')}-sides"
    note = (
        "By rays: equations 4.7 to 4.9, the dissertation's own four rays. By poses: 4.2 to 4.6, repaired. Of potential "
        "fields it does not say which it prints."
    )
    title = f"Adjacency of `{CONTROLLERS[variant]}`, by both of the dissertation's measures"
    return Table(identity, title, columns, tuple(rows), note=note)


def _test_text(test: RecordedTest) -> str:
    """What was trained or run; not how long it took, which says more of the machine and its other work."""
    if not test.steps:
        return f"{', '.join(test.reached)}: {test.episodes} runs"
    return f"seed {test.seed}: {test.steps:,} steps"


def _origin_text(recorded: RecordedResult) -> str:
    """How a result was made: command, commit, settings; the log has the versions of packages."""
    settings = recorded.settings
    commit = f" at commit {settings.commit}" if settings.commit else ""
    how = (
        f"{settings.task}, {settings.algorithm}, preset {settings.preset}" if settings.task else "no training"
    )
    if settings.changed:
        how += f", {settings.changed}"
    if settings.steps is not None:
        how += f", at most {settings.steps:,} steps"
    how += f", {settings.episodes} episodes of each case" if settings.task else ", runs of each case as named"
    return f"`{settings.command}`{commit}: {how}. Log, with the versions of packages: {recorded.file.name}."


def _right_values(misprint: Misprint) -> str:
    found = "; ".join(f"{cell.row}, {cell.column}: {cell.ours:g}" for cell in misprint.cells)
    return f" Right: {found}." if found else ""


def duration_text(seconds: tuple[float, float]) -> str:
    """Says how long trainings take that stop as soon as they reach their goal."""
    expected, most = map(format_seconds, seconds)
    if expected == most:
        return f"at most about {most}"
    return f"about {expected} if training takes as many steps as the dissertation's did, at most about {most}"


def _how_to_run(table: PrintedTable, missing: Durations) -> list[str]:
    """Names the command that makes a result where none is recorded."""
    found = []
    for variant, seconds in missing.items():
        command = f"kit study {table.id} --again{VARIANT_OPTIONS[variant]}"
        found.append(
            f"No recorded result for {VARIANT_TITLES[variant]}. `{command}` makes one: for one seed {duration_text(seconds)}."
        )
    if table.run:
        found.append(f"By hand: `{table.run}`. {table.missing}".strip())
    return found
