"""``kit study``: every table and figure of the dissertation, ours beside it, and the command that makes it again."""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import learning_options, options, report_output

if TYPE_CHECKING:
    from kit.school.report.document import ReportChapter, ReportPlot
    from kit.study.printed_tables import StudyChapter
    from kit.study.study_runs import StudyRun
    from kit.workspace import Workspace


@click.command()
@click.argument("number", nargs=-1, metavar="[[table|figure] NUMBER]")
@click.option("--again", is_flag=True, help="Train and test the table's agents again, by its settings.")
@click.option(
    "--seeds",
    type=click.IntRange(1, 1000),
    default=1,
    show_default=True,
    help="With --again: agents of each kind, from seed 0 on.",
)
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=os.cpu_count() or 1,
    show_default=True,
    help="With --again: trainings side by side; or tasks of an array job.",
)
@click.option(
    "--executor",
    type=click.Choice(["local", "slurm", "dask"]),
    default="local",
    show_default=True,
    help="With --again: where trainings run.",
)
@click.option("--cluster", default="", metavar="ADDRESS", help="Of the Dask scheduler.")
@report_output.output_options
@options.workspace
def command(
    number: tuple[str, ...],
    again: bool,
    seeds: int,
    jobs: int,
    executor: str,
    cluster: str,
    svg_folder: Path | None,
    html_file: Path | None,
    csv_folder: Path | None,
    json_file: Path | None,
    glyphs: str | None,
    workspace: Path | None,
) -> None:
    """List the dissertation's tables and figures, or show one: its printed cells, ours, the difference.

    \b
    kit study                     the list, and what there is of ours
    kit study 3.5                 a table; `kit study figure 3.5` a figure
    kit study 5                   a chapter's list; `kit class study` is all of 5.3
    kit study 3.5 --again         train its agents again; says how long first
    kit study --csv FOLDER        every table as a file

    Tables 5.4 to 5.9 are computed from the dissertation's raw answers. No other
    result comes with the kit: one that --again has made is kept in the
    workspace, in study/NUMBER.jsonl. Only 3.5 and the agents of 4.6 can be made
    again so; elsewhere the text names the commands.

    Interrupt --again as you like: the same command goes on where it was.

    Exit code: 0; 1 a training has failed; 2 there is no such table; 130 Ctrl-C.
    """
    from kit.school.report.document import ClassReport
    from kit.study.recorded_results import RecordedResultError

    title = "The dissertation's tables and figures"
    with learning_options.explained_errors(), report_output.explained_errors():
        opened = options.open_existing_workspace(workspace)
        try:
            kind, wanted = _read_number(number)
            if again:
                _run_again(wanted if kind != "figure" else "", opened, seeds, jobs, executor, cluster)
            to_files = any((svg_folder, html_file, csv_folder, json_file))
            listed, whole = _chapters(kind, wanted, opened, to_files=to_files)
        except RecordedResultError as error:
            options.fail(str(error))
        report_output.write_outputs(
            ClassReport(title, whole),
            svg_folder,
            html_file,
            csv_folder,
            json_file,
            glyphs,
            printed=ClassReport(title, listed) if listed else None,
        )


def _read_number(words: tuple[str, ...]) -> tuple[str, str]:
    """``table``, ``figure`` or nothing, and the number."""
    kind, *rest = words or ("",)
    if kind.lower() in ("table", "figure"):
        if len(rest) != 1:
            options.fail(f"{kind} needs one number, such as `kit study {kind.lower()} 3.5`.")
        return kind.lower(), rest[0]
    if rest:
        options.fail("One number at a time, such as `kit study 3.5` or `kit study figure 3.5`.")
    return "", kind


def _chapters(
    kind: str, wanted: str, workspace: Workspace, *, to_files: bool
) -> tuple[tuple[ReportChapter, ...], tuple[ReportChapter, ...]]:
    """What is printed instead of the whole, if anything; and the whole, which files get."""
    from kit.study.printed_tables import study_chapters

    chapters = study_chapters()
    chosen = [each for each in chapters if not wanted or str(each.number) == wanted]
    if chosen and not kind:
        lists = tuple(_overview(each, workspace) for each in chosen)
        if not to_files:
            return lists, ()
        tables = [_table(number, workspace) for each in chosen for number in _table_numbers(each)]
        return lists, (*lists, *tables, *(_figure(figure.id) for each in chosen for figure in each.figures))
    numbers = {number for each in chapters for number in _table_numbers(each)}
    figures = {figure.id for each in chapters for figure in each.figures}
    known = {"table": numbers, "figure": figures}.get(kind, numbers | figures)
    if wanted not in known:
        from kit.plain_text import suggestion

        what = kind or "table or figure"
        options.fail(f"There is no {what} {wanted!r}: {suggestion(wanted, sorted(known))}")
    is_table = wanted in numbers and kind != "figure"
    return (), (_table(wanted, workspace) if is_table else _figure(wanted),)


def _table_numbers(chapter: StudyChapter) -> Iterator[str]:
    """Those of its own data, then those of the evaluation."""
    from kit.study.evaluation_data import read_evaluation_data

    yield from (each.id for each in chapter.tables)
    if chapter.number == 5:
        yield from (each.id for each in read_evaluation_data().printed)


def _overview(chapter: StudyChapter, workspace: Workspace) -> ReportChapter:
    from kit.study.evaluation_data import read_evaluation_data
    from kit.study.recorded_results import read_recorded_result, recorded_result_file
    from kit.study.study_report import overview_chapter, table_status

    items = []
    for table in chapter.tables:
        recorded = read_recorded_result(recorded_result_file(workspace, table.id))
        items.append((f"Table {table.id}", table.title, table_status(recorded, table)))
    if chapter.number == 5:
        items += [
            (f"Table {each.id}" if each.id != "text" else "text", each.title, "from the answers")
            for each in read_evaluation_data().printed
        ]
    items += [
        (f"Figure {each.id}", each.title, "from the answers" if each.plots else "none")
        for each in chapter.figures
    ]
    note = "`kit class study` is all of section 5.3 at once." if chapter.number == 5 else ""
    note = note or "none: no recorded result; `kit study NUMBER` names the command, or runs it with --again."
    return overview_chapter(chapter, items, note)


def _table(number: str, workspace: Workspace) -> ReportChapter:
    from kit.school.report.document import ReportChapter
    from kit.study.evaluation_data import read_evaluation_data
    from kit.study.evaluation_report import evaluation_table
    from kit.study.printed_tables import study_chapters
    from kit.study.recorded_results import read_recorded_result, recorded_result_file
    from kit.study.study_report import table_chapter
    from kit.study.study_runs import StudyRun

    for chapter in study_chapters():
        for table in chapter.tables:
            if table.id == number:
                recorded = read_recorded_result(recorded_result_file(workspace, number))
                again = (
                    StudyRun(table, workspace).expected_seconds(1, _cores()) if table.repeat_task else None
                )
                return table_chapter(table, chapter.misprints_of(number), recorded, again)
    data = read_evaluation_data()
    found = next(each for each in data.printed if each.id == number)
    return ReportChapter(
        f"table-{number}", f"Chapter 5, section {found.section}", evaluation_table(data, number)
    )


def _figure(number: str) -> ReportChapter:
    from kit.study.printed_tables import study_chapters
    from kit.study.study_report import figure_chapter

    figure = next(each for chapter in study_chapters() for each in chapter.figures if each.id == number)
    return figure_chapter(figure, [_plots()[name] for name in figure.plots])


@cache
def _plots() -> dict[str, ReportPlot]:
    """Those of the evaluation, by name."""
    from kit.study.evaluation_data import read_evaluation_data
    from kit.study.evaluation_report import evaluation_plots

    return evaluation_plots(read_evaluation_data())


def _run_again(number: str, workspace: Workspace, seeds: int, jobs: int, executor: str, cluster: str) -> None:
    """Trains and tests what is missing of a table."""
    from kit.host.job_executors import ExecutorUnavailable
    from kit.learning.training.optional_deps import require_learn_extra
    from kit.study.printed_tables import study_chapters
    from kit.study.study_report import duration_text
    from kit.study.study_runs import StudyRun

    tables = {each.id: each for chapter in study_chapters() for each in chapter.tables if each.repeat_task}
    if number not in tables:
        options.fail(
            f"--again makes Tables {' and '.join(tables)}. `kit study NUMBER` names the commands for the others."
        )
    require_learn_extra()
    run = StudyRun(tables[number], workspace)
    missing = run.missing_seeds(seeds)
    if missing:
        expected = duration_text(run.expected_seconds(seeds, jobs))
        agents = len(missing) * len(run.table.trained_groups)
        click.echo(
            f"Up to {agents} agents to train: {expected}. Ctrl-C keeps what there is.",
            err=True,
        )
    try:
        for seed in missing:
            _run_seed(run, seed, jobs, executor, cluster)
    except ExecutorUnavailable as error:
        options.fail(str(error))
    except KeyboardInterrupt:
        click.echo("\nWhat has been trained is kept: the same command goes on.", err=True)
        raise SystemExit(130) from None


def _run_seed(run: StudyRun, seed: int, jobs: int, executor: str, cluster: str) -> None:
    from kit.cli.sweep import run_sweep
    from kit.learning.training.runs import RunError

    sweep = run.sweep(seed)
    run_sweep(sweep, executor, jobs, cluster)
    try:
        run.record(
            sweep,
            seed,
            lambda test: click.echo(f"{test.group}, seed {seed}: {test.steps:,} steps, tested", err=True),
        )
    except RunError as error:
        click.echo(str(error), err=True)
        raise SystemExit(1) from None


def _cores() -> int:
    return os.cpu_count() or 1
