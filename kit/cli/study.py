"""``kit study``: every table and figure of the dissertation, ours beside it, and the command that makes it again."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Final

import click

from kit.cli import learning_options, messages, opening, options, report_output
from kit.cli.executor_options import executor_options
from kit.cli.process import INTERRUPTED
from kit.cli.sweep import run_sweep
from kit.document.blocks import Document
from kit.host.job_executors import ExecutorUnavailable
from kit.host.job_folder import JobExecutor
from kit.learning.training.learn_extra import require_learn_extra
from kit.learning.training.run_config import RunError
from kit.plain_text import counted
from kit.study import study_document
from kit.study.printed_tables import FIGURE, study_chapters
from kit.study.recorded_results import RecordedResultError
from kit.study.study_check import check_document
from kit.study.study_document import DOCUMENT
from kit.study.study_report import duration_text
from kit.study.study_runs import StudyRun
from kit.study.study_variants import VARIANT_OPTIONS, StudyVariant
from kit.workspace import Workspace


@click.command()
@click.argument("number", nargs=-1, metavar="[[table|figure] NUMBER]")
@click.option("--again", is_flag=True, help="Train and test the table's agents again, with its settings.")
@click.option("--kit", "by_kit", is_flag=True, help="With --again: use the kit's own preset instead.")
@click.option(
    "--no-limit",
    is_flag=True,
    help="With --again: the dissertation's settings without its limit of values (`kit study clip`).",
)
@click.option("--whole", is_flag=True, help="Print everything in the list, not only the list.")
@click.option(
    "--check", is_flag=True, help="Recompute the document that comes with the kit, and print the differences."
)
@click.option(
    "--seeds",
    type=click.IntRange(1, 1000),
    default=1,
    show_default=True,
    help="With --again: agents of each kind, from seed 0.",
)
@click.option(
    "--steps",
    type=click.IntRange(1),
    help="With --again: most steps per training (default: the preset's); the log records it.",
)
@executor_options(
    "With --again: trainings in parallel", "With --again: where trainings run.", may_have_none=False
)
@report_output.output_options
@options.workspace
def command(
    number: tuple[str, ...],
    again: bool,
    by_kit: bool,
    no_limit: bool,
    whole: bool,
    check: bool,
    seeds: int,
    steps: int | None,
    executor: JobExecutor,
    outputs: report_output.ReportOutputs,
    workspace: Path | None,
) -> None:
    """List the dissertation's tables and figures, or show one: printed values, our values, differences.

    \b
    kit study                     the list, with the results available
    kit study 3.5                 a table; `kit study figure 3.5` a figure
    kit study 5                   a chapter's list; --whole prints all of it
    kit study 3.5 --again         train its agents again; prints the time first
    kit study 3.5 --again --kit   the same with the kit's own preset
    kit study 4.1 --again --no-limit   without his library's limit of values
    kit study clip                values with and without that limit; --again
                                  makes both again, in about three minutes
    kit study author              what the author's own agents reach here
    kit study --html FOLDER       everything on one page; --csv for tables
    kit study --check             check that the document follows from the logs

    "ours" are agents trained with the dissertation's settings, "kit" with the
    kit's own preset, each on its own group of cases only. Results of both come
    with the kit; --again saves its results in the workspace, in
    study/NUMBER.jsonl, NUMBER-kit.jsonl or NUMBER-no-limit.jsonl, and they
    are shown instead. Tables
    5.4 to 5.9 are computed from the dissertation's raw answers.

    You can interrupt --again; run the same command to continue.

    Exit code: 0 success; 1 a training failed, or --check found a difference;
    2 there is no such table; 130 interrupted by Ctrl-C.
    """
    with learning_options.explained_errors(), report_output.explained_errors():
        opened = opening.open_existing_workspace(workspace)
        try:
            if check:
                _check_document()
                return
            kind, wanted = _read_number(number)
            if again:
                if by_kit and no_limit:
                    messages.fail("--kit and --no-limit are two ways to train: give one of them.")
                variant: StudyVariant = "kit" if by_kit else "no-limit" if no_limit else "seed"
                for each in _wanted_variants(wanted, variant):
                    _run_again(
                        f"figure-{wanted}" if kind == "figure" or wanted in FIGURES_ALONE else wanted,
                        opened,
                        each,
                        seeds,
                        steps,
                        executor,
                    )
            to_files = outputs.has_files
            listed, everything = study_document.chapters(
                kind, wanted, opened, to_files=to_files or whole, with_class=whole
            )
        except (RecordedResultError, study_document.UnknownStudyNumber) as error:
            messages.fail(str(error))
        report_output.write_outputs(
            Document(study_document.TITLE, everything),
            outputs,
            printed=Document(study_document.TITLE, listed) if listed and not whole else None,
        )


FIGURES_ALONE: Final = tuple(
    figure.id for chapter in study_chapters() for figure in chapter.figures if figure.sessions == "values"
)
"""Figures that are none of the dissertation's: their names need no word before them."""


def _wanted_variants(wanted: str, variant: StudyVariant) -> tuple[StudyVariant, ...]:
    """How a number is trained again: a figure that compares is trained both ways."""
    return ("seed", "no-limit") if wanted in FIGURES_ALONE else (variant,)


def _read_number(words: tuple[str, ...]) -> tuple[str, str]:
    """``table``, ``figure`` or nothing, and the number; also from one word: ``"figure 3.5"``, ``figure-3.5``."""
    kind, *rest = re.sub(r"(?i)^(table|figure)-", r"\1 ", " ".join(words)).split() or [""]
    if kind.lower() in ("table", "figure"):
        if len(rest) != 1:
            messages.fail(f"{kind} needs one number, such as `kit study {kind.lower()} 3.5`.")
        return kind.lower(), rest[0]
    if rest:
        messages.fail("Give one number at a time, such as `kit study 3.5` or `kit study figure 3.5`.")
    return "", kind


def _check_document() -> None:
    """Prints what differs between the document that comes with the kit and what its logs give; exits with 1 then."""
    differences = check_document()
    for line in differences[:20]:
        click.echo(line, err=True)
    if differences:
        click.echo(f"{counted(len(differences), 'difference')}.", err=True)
        raise SystemExit(1)
    click.echo(f"Every number of {DOCUMENT} follows from the logs beside it.")


def _run_again(
    number: str,
    workspace: Workspace,
    variant: StudyVariant,
    seeds: int,
    steps: int | None,
    executor: JobExecutor,
) -> None:
    """Trains and tests what is missing of a table; runs its potential fields."""
    tables = {each.id: each for chapter in study_chapters() for each in chapter.tables}
    trainings = (figure.training for chapter in study_chapters() for figure in chapter.figures)
    tables |= {each.id: each for each in trainings if each is not None}
    studies = {each.id: StudyRun.of(each, workspace, variant, steps) for each in tables.values()}
    able = {name: run for name, run in studies.items() if run.groups or run.has_potential_fields}
    run = able.get(number)
    if run is None:
        words = VARIANT_OPTIONS[variant]
        messages.fail(
            f"--again{words} cannot reproduce that; it can reproduce {', '.join(able).replace(FIGURE, 'figure ')}."
        )
    if run.groups:
        require_learn_extra()
    try:
        missing = run.missing_seeds(seeds)
        if missing or run.misses_fields:
            agents, runs = len(missing) * len(run.groups), run.fields_runs
            work = [f"up to {counted(agents, 'agent')} to train"] * (agents > 0) + [
                f"{counted(runs, 'run')} of potential fields"
            ] * (runs > 0)
            expected = duration_text(run.expected_seconds(seeds, executor.jobs))
            told = " and ".join(work)
            click.echo(f"{told[0].upper()}{told[1:]}: {expected}. Ctrl-C keeps the results so far.", err=True)
        if run.misses_fields:
            _run_fields(run)
        for seed in missing:
            _run_seed(run, seed, executor)
        run.record_paths(lambda figure: click.echo(f"paths of figure {figure.id}: recorded", err=True))
    except (ExecutorUnavailable, RunError) as error:
        click.echo(str(error), err=True)
        raise SystemExit(1) from None
    except KeyboardInterrupt:
        click.echo("\nFinished training is kept; run the same command to continue.", err=True)
        raise SystemExit(INTERRUPTED) from None


def _run_fields(run: StudyRun) -> None:
    total = run.fields_runs
    with click.progressbar(length=total, label="potential fields", file=sys.stderr) as bar:
        run.record_fields(lambda case, number: bar.update(1))


def _run_seed(run: StudyRun, seed: int, executor: JobExecutor) -> None:
    sweep = run.sweep(seed)
    run_sweep(sweep, executor)
    run.record(
        sweep,
        seed,
        lambda test: click.echo(f"{test.group}, seed {seed}: {test.steps:,} steps, tested", err=True),
    )
