"""``grader ladder``: all programs of a folder against each other on levels of the game."""

from __future__ import annotations

import sys
from pathlib import Path

import click

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
def ladder(folder: Path, names: tuple[str, ...], as_csv: bool) -> None:
    """Race all programs of FOLDER against each other, and rank them.

    Each Python file of the folder is a program; of each folder in it, the only Python file. Every program drives every
    level; of two, the one that reaches the goal, touches nothing and is sooner there wins. Strengths are Elo points of
    the Bradley-Terry model; the interval is a bootstrap over levels, so few levels make wide ones.

    Exit code: 0; 2 an argument is wrong.
    """
    from grader.cohort.program_ladder import LadderRace, find_programs, race_all, rank
    from kit.school.game.levels import UnknownLevel, find_level

    programs = find_programs(folder)
    if len(programs) < 2:
        raise click.UsageError(f"{folder}: a ladder takes two programs or more; there are {len(programs)}.")
    try:
        levels = [find_level(name) for name in names or DEFAULT_LEVELS]
    except UnknownLevel as error:
        raise click.UsageError(str(error)) from None

    def report(race: LadderRace) -> None:
        if sys.stderr.isatty():
            click.echo(f"\r{race.level}: {race.program:<40.40}", nl=False, err=True)

    rows = rank(race_all(programs, levels, report))
    if sys.stderr.isatty():
        click.echo(f"\r{'':<70}\r", nl=False, err=True)
    if as_csv:
        click.echo("place,program,elo,low,high,wins,races")
        for place, each in enumerate(rows, 1):
            low, high = each.interval
            click.echo(
                f"{place},{each.program},{each.elo:.0f},{low:.0f},{high:.0f},{each.wins:g},{each.races}"
            )
        return
    click.echo(f"{'':>4} {'program':<28} {'Elo':>6} {'95 %':>14}   won")
    for place, each in enumerate(rows, 1):
        interval = f"{each.interval[0]:+.0f} to {each.interval[1]:+.0f}"
        click.echo(
            f"{place:>3}. {each.program:<28.28} {each.elo:>+6.0f} {interval:>14}   {each.wins:g} of {each.races}"
        )
