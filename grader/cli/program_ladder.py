"""``grader ladder``: all programs of a folder against each other on levels of the game."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import click

from grader.cli import options

DEFAULT_LEVELS = ("left-turn", "right-turn", "parking", "roundabout", "about-turn")


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option(
    "--level",
    "names",
    multiple=True,
    metavar="NAME",
    help=f"A level to race on; may be given several times. By default {', '.join(DEFAULT_LEVELS)}.",
)
@click.option("--csv", "as_csv", is_flag=True, help="Comma-separated values instead of a table.")
@click.option(
    "--unconfined",
    is_flag=True,
    help="Race them even where this machine does not reach confinement level 1.",
)
def ladder(folder: Path, names: tuple[str, ...], as_csv: bool, unconfined: bool) -> None:
    """Race all programs of FOLDER against each other, and rank them.

    Each Python file of the folder is a program; of each folder in it, the only Python file. Every program drives every
    level; of two, the one that reaches the goal, touches nothing and is sooner there wins. Strengths are Elo points of
    the Bradley-Terry model; the interval is a bootstrap over levels, so few levels make wide ones.

    They run at confinement level 1. Exit code: 0; 2 an argument is wrong, or this machine does not reach that level.
    """
    from grader.cohort.program_ladder import LadderRace, find_programs, race_all, rank
    from grader.reports.cleaning import clean_line, spreadsheet_cell
    from kit.host.sandbox.confinement import Level
    from kit.host.sandbox.probe import is_level_available
    from kit.school.game.levels import UnknownLevel, find_level

    if not unconfined and not is_level_available(Level.FILTERED):
        options.fail(
            "This machine does not reach confinement level 1; `kit doctor` says why. To race without it, say --unconfined: "
            "then a program that was handed in can read and change whatever you can."
        )
    programs = find_programs(folder)
    if len(programs) < 2:
        raise click.UsageError(f"{folder}: a ladder takes two programs or more; there are {len(programs)}.")
    try:
        levels = [find_level(name) for name in names or DEFAULT_LEVELS]
    except UnknownLevel as error:
        raise click.UsageError(str(error)) from None

    def report(race: LadderRace) -> None:
        if sys.stderr.isatty():
            click.echo(f"\r{race.level}: {clean_line(race.program):<40.40}", nl=False, err=True)

    races = race_all(programs, levels, report)
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
    click.echo(f"{'':>4} {'program':<28} {'Elo':>6} {'95 %':>14}   won")
    for place, each in enumerate(rows, 1):
        interval = f"{each.interval[0]:+.0f} to {each.interval[1]:+.0f}"
        click.echo(
            f"{place:>3}. {clean_line(each.program):<28.28} {each.elo:>+6.0f} {interval:>14}   {each.wins:g} of {each.races}"
        )
