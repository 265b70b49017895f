"""The whole study as one report: lists, tables, figures; and the document that comes with the kit."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Final

from kit.document.blocks import (
    Block,
    CellStyle,
    Chapter,
    Column,
    Document,
    Plot,
    Table,
    Text,
)
from kit.document.markdown import document_to_markdown
from kit.plain_text import unknown_name
from kit.study.author_agents import author_agents_table
from kit.study.evaluation import evaluation_chapters, evaluation_plots, evaluation_table
from kit.study.evaluation_data import EvaluationData, read_evaluation_data
from kit.study.printed_tables import (
    POTENTIAL_FIELDS,
    PrintedFigure,
    PrintedTable,
    StudyChapter,
    printed_table,
    study_chapters,
)
from kit.study.recorded_results import RecordedResult, Results
from kit.study.result_logs import SHIPPED_FOLDER, find_recorded_result, find_recorded_results
from kit.study.seed_spread import cells_below
from kit.study.study_report import (
    Durations,
    figure_chapter,
    overview_chapter,
    paths_title,
    session_plot,
    table_chapter,
    table_status,
)
from kit.study.study_summary import summary_chapter
from kit.study.study_variants import VARIANT_NAMES, VARIANTS, StudyVariant
from kit.study.value_blocks import value_blocks
from kit.workspace import Workspace

AUTHOR: Final = "author"
"""Stands for the chapter on the author's own agents."""
TITLE: Final = "The dissertation's tables and figures"
DOCUMENT: Final = SHIPPED_FOLDER / "STUDY.md"
"""The document that comes with the kit."""


FAILURES_NOTE: Final = (
    "Every recorded cell whose 95 % interval lies below the printed number. Seeds were fixed before and are 0, 1, ...; no "
    "agent was trained again, and no setting changed, for any of these."
)
_VARIANT_WORDS: Final[Mapping[StudyVariant, str]] = {
    "seed": "by the dissertation's settings",
    "no-limit": "by the same without their limit of values",
    "kit": "by the kit's own preset",
}
PATHS_LEGEND: Final = (
    "Solid: the left or only robot, dashed: the right one, with a mark for every second; dotted: the target was not "
    "reached. S: starts; T or a circle: targets."
)
CHOSEN_EPISODES: Final = "Of 20 episodes, the first that reached the target and the first that did not are shown, then the next ones."
FIRST_RUN: Final = (
    "The first of the table's runs, from the case's exact start; one that gets stuck counts as timed out."
)


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
        lists = tuple(_overview_chapter(each, workspace) for each in chosen)
        if not to_files:
            return lists, ()
        tables = [_table_chapter(number, workspace) for each in chosen for number in _table_numbers(each)]
        figures = [
            _figure_chapter(figure, workspace, with_plots=with_plots)
            for each in chosen
            for figure in each.figures
            if with_plots or not figure.plots
        ]
        failures = _failure_chapters(chosen, workspace)
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
        raise UnknownStudyNumber(unknown_name(what, wanted, sorted(allowed), "kit study"))
    is_table = wanted in numbers and kind != "figure"
    return (), (
        _table_chapter(wanted, workspace) if is_table else _figure_chapter(pictures[wanted], workspace),
    )


def _evaluation_chapters(chosen: list[StudyChapter], with_class: bool) -> tuple[Chapter, ...]:
    """What chapter 5 has beside its tables and figures."""
    if all(each.number != 5 for each in chosen):
        return ()
    return evaluation_chapters(_evaluation(), with_class=with_class)


def _failure_chapters(chosen: list[StudyChapter], workspace: Workspace | None) -> Iterator[Chapter]:
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
        for variant, result in find_recorded_results(table, workspace).items()
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


def recorded_study_document() -> str:
    """The document as it follows from the printed cells and the logs that come with the kit."""
    _, whole = chapters("", "", None, to_files=True, with_plots=False)
    return document_to_markdown(Document(TITLE, whole))


def _table_numbers(chapter: StudyChapter) -> Iterator[str]:
    """The numbers of the tables of its own data, then of the evaluation's."""
    yield from (each.id for each in chapter.tables)
    if chapter.number == 5:
        yield from (each.id for each in _evaluation().printed)


def _overview_chapter(chapter: StudyChapter, workspace: Workspace | None) -> Chapter:
    items = [
        (f"Table {table.id}", table.title, table_status(find_recorded_results(table, workspace), table))
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
        for variant, result in find_recorded_results(table, workspace).items():
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


def _table_chapter(number: str, workspace: Workspace | None) -> Chapter:
    for chapter in study_chapters():
        for table in chapter.tables:
            if table.id == number:
                results = find_recorded_results(table, workspace)
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
        if variant not in results and (run.groups or run.has_potential_fields):
            cores = 1 if workspace is None else os.cpu_count() or 1
            found[variant] = run.expected_seconds(1, cores)
    return found


def _figure_chapter(
    figure: PrintedFigure, workspace: Workspace | None, *, with_plots: bool = True
) -> Chapter:
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
    from kit.study.study_paths import path_plots  # brings environments along

    choice = FIRST_RUN if figure.group == POTENTIAL_FIELDS else CHOSEN_EPISODES
    return [*path_plots(figure, recorded), Text(f"{PATHS_LEGEND} {choice}")]


def _figure_plots(
    figure: PrintedFigure, workspace: Workspace | None
) -> tuple[list[Block], RecordedResult | None]:
    """Makes the plots of a figure from the raw answers, or from the first agent of its group that was recorded."""
    if not figure.results_of:
        return [_evaluation_plots()[name] for name in figure.plots], None
    if figure.sessions == "values":
        results = find_recorded_results(printed_table(figure.results_of), workspace)
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
    """The plots of the evaluation, by name."""
    return evaluation_plots(_evaluation())
