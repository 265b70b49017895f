"""The whole study as one report: lists, tables, figures; the document that comes with the kit, and its check."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import zip_longest
from pathlib import Path
from typing import Final

from kit.document.blocks import (
    Block,
    Cell,
    CellStyle,
    Chapter,
    Column,
    Document,
    Plot,
    Table,
    Text,
)
from kit.document.markdown import document_to_markdown, table_to_markdown
from kit.learning.tasks.catalogue import find_task
from kit.plain_text import suggestion
from kit.study.author_agents import author_agents_table, read_author_agents
from kit.study.evaluation import (
    EvaluationData,
    evaluation_chapters,
    evaluation_plots,
    evaluation_table,
    read_evaluation_data,
)
from kit.study.printed_tables import (
    ADJACENCY,
    ADJACENCY_BY_POSES,
    POTENTIAL_FIELDS,
    STEPS,
    SUCCESS,
    SUMMARY_ROWS,
    PrintedFigure,
    PrintedTable,
    StudyChapter,
    printed_table,
    study_chapters,
)
from kit.study.recorded_results import (
    SHIPPED_FOLDER,
    VARIANT_NAMES,
    VARIANTS,
    RecordedResult,
    StudyVariant,
    TrainedSeeds,
    cells_below,
    find_recorded_result,
    seed_means,
)
from kit.study.study_report import (
    Durations,
    RecordedCells,
    Results,
    figure_chapter,
    overview_chapter,
    paths_title,
    session_plot,
    table_chapter,
    table_status,
    value_blocks,
)
from kit.study.task_comparison import test_differences
from kit.workspace import Workspace

AUTHOR: Final = "author"
"""Stands for the chapter on the author's own agents."""
TITLE: Final = "The dissertation's tables and figures"
DOCUMENT: Final = SHIPPED_FOLDER / "STUDY.md"
"""The document that comes with the kit."""
README: Final = Path(__file__).parents[2] / "README.md"
"""There only where the kit runs from its source."""


class UnknownStudyNumber(LookupError):
    """No table or figure has that number; the message offers the nearest one."""


def chapters(
    kind: str,
    wanted: str,
    workspace: Workspace | None,
    *,
    to_files: bool,
    with_plots: bool = True,
    with_class: bool = False,
) -> tuple[tuple[Chapter, ...], tuple[Chapter, ...]]:
    """What is printed instead of the whole, if anything; and the whole, which files get.

    ``kind``: ``table``, ``figure`` or empty for either. ``wanted``: a number; that of a chapter, or empty, for a list. ``workspace``:
    where results of one's own are; None for those that come with the kit alone. ``with_plots``: whether figures that are
    plots of the raw answers are drawn. ``with_class``: whether chapter 5 has every chapter that a class gets, too.
    Raises UnknownStudyNumber and RecordedResultError.
    """
    known = study_chapters()
    chosen = [each for each in known if not wanted or str(each.number) == wanted]
    if chosen and not kind:
        lists = tuple(_overview(each, workspace) for each in chosen)
        if not to_files:
            return lists, ()
        tables = [_table(number, workspace) for each in chosen for number in _table_numbers(each)]
        figures = [
            _figure(figure, workspace, with_plots=with_plots)
            for each in chosen
            for figure in each.figures
            if with_plots or not figure.plots
        ]
        failures = _failures(chosen, workspace)
        head = () if wanted else (summary_chapter(),)
        return lists, (*head, *lists, *failures, *tables, *_evaluation_chapters(chosen, with_class), *figures)
    if wanted == AUTHOR and not kind:
        text = "What the author's own published agents reach in this simulator."
        return (), (Chapter(AUTHOR, "The author's agents", (Text(text), author_agents_table())),)
    numbers = {AUTHOR, *(number for each in known for number in _table_numbers(each))}
    pictures = {figure.id: figure for each in known for figure in each.figures}
    allowed = {"table": numbers, "figure": set(pictures)}.get(kind, numbers | set(pictures))
    if wanted not in allowed:
        what = kind or "table or figure"
        raise UnknownStudyNumber(f"There is no {what} {wanted!r}: {suggestion(wanted, sorted(allowed))}")
    is_table = wanted in numbers and kind != "figure"
    return (), (_table(wanted, workspace) if is_table else _figure(pictures[wanted], workspace),)


def _evaluation_chapters(chosen: list[StudyChapter], with_class: bool) -> tuple[Chapter, ...]:
    """What chapter 5 has beside its tables and figures."""
    if all(each.number != 5 for each in chosen):
        return ()
    return evaluation_chapters(_evaluation(), with_class=with_class)


def _failures(chosen: list[StudyChapter], workspace: Workspace | None) -> Iterator[Chapter]:
    """Every recorded cell of these chapters that lies below the print."""
    tables = [table for chapter in chosen for table in chapter.tables]
    rows = [
        (
            f"{each.table}, {each.column}",
            each.row,
            VARIANT_NAMES[variant],
            each.printed,
            each.value,
            each.high,
        )
        for table in tables
        for variant, result in _results(table, workspace).items()
        for each in cells_below(table, result.cells(table))
    ]
    if rows:
        heads = ("table", "row", "whose")
        columns = (
            *(Column(head, CellStyle.TEXT) for head in heads),
            *(Column(head, decimals=3) for head in ("printed", "recorded", "at most")),
        )
        table = Table("failures", "", columns, tuple(rows))
        yield Chapter("failures", "Below the printed number", (Text(FAILURES_NOTE), table))


FAILURES_NOTE: Final = (
    "Every recorded cell whose 95 % interval lies below the printed number. Seeds were fixed before and are 0, 1, ...; no "
    "agent was trained again, and no setting changed, for any of these."
)


def recorded_study_document() -> str:
    """The document as it follows from the printed cells and the logs that come with the kit."""
    _, whole = chapters("", "", None, to_files=True, with_plots=False)
    return document_to_markdown(Document(TITLE, whole))


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
            found += incomparable_rows(table, _results(table, None))
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
        results = _results(table, None)
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
        results = {name: result for name, result in _results(table, None).items() if name != "no-limit"}
        cells = {name: result.cells(table) for name, result in results.items()}
        for column, measure in zip(table.columns, table.measures, strict=True):
            if measure == STEPS:
                continue
            printed = {row: table.cell(row, column) for row in _own_rows(table)}
            label = f"{number}, {_measured(column, measure)}".rstrip(", ")
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


def _measured(column: str, measure: str) -> str:
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


def _table_numbers(chapter: StudyChapter) -> Iterator[str]:
    """Those of its own data, then those of the evaluation."""
    yield from (each.id for each in chapter.tables)
    if chapter.number == 5:
        yield from (each.id for each in _evaluation().printed)


def _results(table: PrintedTable, workspace: Workspace | None) -> Results:
    """Those that there are."""
    found = {variant: find_recorded_result(workspace, table, variant) for variant in VARIANTS}
    return {variant: result for variant, result in found.items() if result is not None}


def _overview(chapter: StudyChapter, workspace: Workspace | None) -> Chapter:
    items = [
        (f"Table {table.id}", table.title, table_status(_results(table, workspace), table))
        for table in chapter.tables
    ]
    if chapter.number == 5:
        items += [
            (f"Table {each.id}" if each.id != "text" else "text", each.title, "from the answers")
            for each in _evaluation().printed
        ]
    for figure in chapter.figures:
        status = "from the answers" if figure.plots else "none"
        if figure.results_of:
            is_recorded = _is_recorded(figure, workspace)
            status = "recorded" if is_recorded else f"none; {figure.run.removeprefix('kit study ')}"
        name = figure.id if figure.sessions == "values" else f"Figure {figure.id}"
        items.append((name, figure.title, status))
    names = "; ".join(f"{VARIANT_NAMES[each]}: {_VARIANT_WORDS[each]}" for each in VARIANTS)
    notes = [f"Recorded agents, {names}. `kit study NUMBER` shows one."]
    if chapter.number == 5:
        notes.append("`kit study 5 --whole` is all of it at once.")
    if failing := _failure_counts(chapter, workspace):
        notes.append(
            f"Cells whose 95 % interval lies below the printed number: {failing}; each table names its own."
        )
    return overview_chapter(chapter, items, notes)


def _failure_counts(chapter: StudyChapter, workspace: Workspace | None) -> str:
    """How many recorded cells lie below the print; empty if none can."""
    counts: dict[StudyVariant, tuple[int, int]] = {}
    for table in chapter.tables:
        for variant, result in _results(table, workspace).items():
            cells = result.cells(table)
            below, of = counts.get(variant, (0, 0))
            counts[variant] = (
                below + sum(1 for _ in cells_below(table, cells)),
                of + sum(cell.interval is not None for cell in cells.values()),
            )
    return ", ".join(f"{VARIANT_NAMES[name]} {below} of {of}" for name, (below, of) in counts.items())


def _is_recorded(figure: PrintedFigure, workspace: Workspace | None) -> bool:
    if not figure.paths:
        return bool(_figure_plots(figure, workspace)[0])
    recorded = find_recorded_result(workspace, printed_table(figure.results_of))
    return recorded is not None and any(recorded.paths_of(figure.group, case) for _, case in figure.paths)


_VARIANT_WORDS: Final[Mapping[StudyVariant, str]] = {
    "seed": "by the dissertation's settings",
    "no-limit": "by the same without their limit of values",
    "kit": "by the kit's own preset",
}


def _table(number: str, workspace: Workspace | None) -> Chapter:
    for chapter in study_chapters():
        for table in chapter.tables:
            if table.id == number:
                results = _results(table, workspace)
                missing = _durations(table, workspace, results)
                return table_chapter(table, chapter.misprints_of(number), results, missing)
    data = _evaluation()
    found = next(each for each in data.printed if each.id == number)
    return Chapter(f"table-{number}", f"Chapter 5, section {found.section}", evaluation_table(data, number))


def _durations(table: PrintedTable, workspace: Workspace | None, results: Results) -> Durations:
    """How long it would take to make the results that are not there, on this machine."""
    from kit.study.study_runs import StudyRun  # brings training along

    found: dict[StudyVariant, tuple[float, float]] = {}
    for variant in VARIANTS:
        run = StudyRun.of(table, workspace or Workspace(Path()), variant)
        if variant == "no-limit" and not table.prints_best_test:
            continue
        if variant not in results and (run.groups or run.has_fields):
            cores = 1 if workspace is None else os.cpu_count() or 1
            found[variant] = run.expected_seconds(1, cores)
    return found


def _figure(figure: PrintedFigure, workspace: Workspace | None, *, with_plots: bool = True) -> Chapter:
    if figure.paths:
        recorded = find_recorded_result(workspace, printed_table(figure.results_of))
        return figure_chapter(figure, _figure_paths(figure, recorded, with_plots=with_plots), recorded)
    plots, recorded = _figure_plots(figure, workspace)
    return figure_chapter(figure, plots, recorded)


def _figure_paths(figure: PrintedFigure, recorded: RecordedResult | None, *, with_plots: bool) -> list[Block]:
    """The recorded ways: drawn, or only how they ended; none where there are none."""
    if recorded is None:
        return []
    ways = {case: recorded.paths_of(figure.group, case) for _, case in figure.paths}
    if not with_plots:
        return [Text(f"{paths_title(figure, case, some)}.") for case, some in ways.items() if some]
    if not any(ways.values()):
        return []
    from kit.study.study_runs import path_plots  # brings environments along

    choice = FIRST_RUN if figure.group == POTENTIAL_FIELDS else CHOSEN_EPISODES
    return [*path_plots(figure, recorded), Text(f"{PATHS_LEGEND} {choice}")]


PATHS_LEGEND: Final = (
    "Solid: the left or only robot, dashed: the right one, with a mark for every second; dotted: the target was not "
    "reached. S: starts; T or a circle: targets."
)
CHOSEN_EPISODES: Final = "Of 20 episodes, the first that reached the target and the first that did not are shown, then the next ones."
FIRST_RUN: Final = (
    "The first of the table's runs, from the case's exact start; one that gets stuck counts as timed out."
)


def _figure_plots(
    figure: PrintedFigure, workspace: Workspace | None
) -> tuple[list[Block], RecordedResult | None]:
    """Makes the plots of a figure from the raw answers, or from the first agent of its group that was recorded."""
    if not figure.results_of:
        return [_evaluation_plots()[name] for name in figure.plots], None
    if figure.sessions == "values":
        results = _results(printed_table(figure.results_of), workspace)
        return value_blocks(figure, results), results.get("seed")
    recorded = find_recorded_result(workspace, printed_table(figure.results_of))
    tests = recorded.tests_of(figure.group) if recorded else ()
    plots = [session_plot(figure, test) for test in tests[:1]]
    return [plot for plot in plots if plot is not None], recorded


@cache
def _evaluation() -> EvaluationData:
    return read_evaluation_data()


@cache
def _evaluation_plots() -> dict[str, Plot]:
    """Those of the evaluation, by name."""
    return evaluation_plots(_evaluation())
