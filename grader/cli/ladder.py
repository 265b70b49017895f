"""``grader ladder``: all programs in a folder race, and are ranked."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import click

from grader.cli import exits
from grader.cohort.class_findings import passed_over_line
from grader.cohort.program_ladder import LadderRace, find_programs, race_all, rank
from grader.reports.cleaning import clean_line, spreadsheet_cell
from kit.cli.existing_path import ExistingPath
from kit.cli.messages import describe_error
from kit.document.blocks import CellStyle, Column, Table
from kit.document.layout import lines_of
from kit.host.sandbox import probe
from kit.host.sandbox.sandbox_config import Level
from kit.school.game.levels import UnknownLevel, find_level

DEFAULT_LEVELS = ("left-turn", "right-turn", "parking", "roundabout", "about-turn")


@click.command()
@click.argument("folder", type=ExistingPath(file_okay=False, path_type=Path))
@click.option(
    "--level",
    "names",
    multiple=True,
    metavar="NAME",
    help=f"Level to race on; repeat for more (default: {', '.join(DEFAULT_LEVELS)}).",
)
@click.option("--csv", "as_csv", is_flag=True, help="Print CSV instead of a table.")
@click.option(
    "--unconfined",
    is_flag=True,
    help="Race them even if this machine does not reach confinement level 1.",
)
def ladder(folder: Path, names: tuple[str, ...], as_csv: bool, unconfined: bool) -> None:
    """Race all programs in FOLDER against each other, and rank them.

    A program is a Python file in FOLDER, or the only Python file in a folder below it. Every program drives every
    level. Of two programs, the winner is the one that reaches the goal, touches nothing, and is faster, in this order.
    Ratings are Elo points of the Bradley-Terry model; the interval is a bootstrap over levels, so few levels make wide
    intervals.

    Programs run at confinement level 1.

    Exit code: 0 success; 2 an argument is wrong, or this machine does not reach that level.
    """
    if not unconfined and not probe.is_level_available(Level.FILTERED):
        exits.fail(
            "This machine does not reach confinement level 1; `kit doctor` says why. To race without it, use --unconfined: "
            "a submitted program can then read and change anything that you can."
        )
    programs, passed_over = find_programs(folder)
    if told := passed_over_line(passed_over, "raced"):
        exits.warn(told)
    if len(programs) < 2:
        raise click.UsageError(f"{folder}: a ladder needs at least two programs; it has {len(programs)}.")
    try:
        levels = [find_level(name) for name in names or DEFAULT_LEVELS]
    except UnknownLevel as error:
        raise click.UsageError(str(error)) from None

    def report(race: LadderRace) -> None:
        if sys.stderr.isatty():
            click.echo(f"\r{race.level}: {clean_line(race.program):<40.40}", nl=False, err=True)

    try:
        races = race_all(programs, levels, report)
    except OSError as error:
        exits.fail(describe_error(error))
    rows = rank(races)
    if sys.stderr.isatty():
        click.echo(f"\r{'':<70}\r", nl=False, err=True)
    failures = {race.program: race.failure for race in races if race.failure}
    for name, failure in failures.items():
        click.echo(f"{clean_line(name)}: {clean_line(failure)}", err=True)
    if as_csv:
        writer = csv.writer(sys.stdout, lineterminator="\n", quoting=csv.QUOTE_ALL)
        writer.writerow(["place", "program", "elo", "low", "high", "wins", "races"])
        for place, each in enumerate(rows, 1):
            numbers = [f"{number:.0f}" for number in (each.elo, *each.interval)]
            writer.writerow([place, spreadsheet_cell(each.program), *numbers, f"{each.wins:g}", each.races])
        return
    columns = (
        Column(""),
        Column("program", CellStyle.TEXT),
        Column("Elo"),
        Column("95 %"),
        Column("won"),
    )
    cells = tuple(
        (
            f"{place}.",
            clean_line(each.program),
            f"{each.elo:+.0f}",
            "{:+.0f} to {:+.0f}".format(*each.interval),
            f"{each.wins:g} of {each.races}",
        )
        for place, each in enumerate(rows, 1)
    )
    click.echo("\n".join(lines_of([Table("ladder", "", columns, cells, is_ruled=False)])))
