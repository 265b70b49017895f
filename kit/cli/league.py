"""``kit league``: programs and agents that meet each other, rated by what came of it."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import messages, options, terminal_options
from kit.cli.executor_options import executor_options
from kit.cli.full_screen import show_screen
from kit.cli.lazy_group import HintingGroup
from kit.controllers import find_controller, prepare_workspace
from kit.document.layout import lines_of
from kit.host.job_executors import ExecutorUnavailable, read_shard
from kit.host.job_folder import serve_keys
from kit.host.sandbox.sandbox_config import Level
from kit.plain_text import counted
from kit.workspace import Workspace, WorkspaceError

if TYPE_CHECKING:
    from textual.screen import Screen

    from kit.host.job_folder import JobExecutor
    from kit.school.game.league.league import League, LeagueJob
    from kit.school.game.league.standings import Standings
    from kit.tui.app import KitApp

INCOMPLETE = 1
"""Exit code of ``run`` and ``verify``: matches are missing, or are others than their programs drive."""


@contextmanager
def _open_league(context: click.Context) -> Iterator[tuple[League, Workspace]]:
    """The league that the group's options name, and the workspace; every error of the user's ends the verb with a message."""
    from kit.school.game.league.entries import LeagueError
    from kit.school.game.league.league import own_league

    workspace, folder = context.obj
    try:
        opened = prepare_workspace(workspace)
        yield own_league(opened, folder), opened
    except (LeagueError, WorkspaceError) as error:
        messages.fail(str(error))


@click.group(cls=HintingGroup, invoke_without_command=True)
@options.workspace
@click.option(
    "--folder",
    type=click.Path(path_type=Path),
    help="Folder of the league (default: $KIT_LEAGUE, or your own).",
)
@click.option("--plain", is_flag=True, help="Print the standings as text instead of a full screen.")
@click.pass_context
def command(context: click.Context, workspace: Path | None, folder: Path | None, plain: bool) -> None:
    """Enter programs and agents in a league; all meet all in races and at tag, and are rated.

    \b
    kit league                          standings; Enter: matches, replays
    kit league submit --controller FILE enter a program
    kit league submit --agent RUN       enter an agent that you trained
    kit league run                      drive the matches that are missing
    kit league matches [NAME]           list matches
    kit league replay 3                 watch match 3
    kit league verify                   drive matches anew and compare
    kit league withdraw NAME            take your entry out
    kit league new FOLDER               a league for a class

    In a race each entrant drives a level alone, from five starts, and the middle drives are compared; a drive ends after five
    times the reference drive's time. At tag two robots share one world: a program is told is_catcher (std_msgs/Bool) and, as goal_pose (geometry_msgs/PoseStamped), where the
    other robot is; it has a namespace of its own and can use no name outside. Each second counts against the catcher, or
    against the other one while that alone stands still; each pair plays twice. Programs are confined as when they are graded.

    Whoever enters first meets the programs of the house, three that come with the kit: they win no title,
    and `kit league run --no-house` leaves them out.

    Ratings follow Bradley and Terry: 400 points more mean ten times as many wins. Only the commands of a drive are stored:
    everybody's kit runs them again and judges them, so a result that is no drive does not count.
    """
    context.obj = workspace, folder
    if context.invoked_subcommand is not None:
        return
    with _open_league(context) as (league, opened):
        terminal = terminal_options.decide(plain=plain)
        if not terminal.plain.value:

            def make_screen(app: KitApp) -> Screen[None]:
                from kit.tui.screens.league import LeagueScreen

                return LeagueScreen(app.kit_theme, league, opened)

            league.programme()
            show_screen(terminal, make_screen)
        _print_standings(league)


@command.command("new")
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--title", default="The class's league", show_default=True, help="What it is called.")
@click.option(
    "--race", "races", multiple=True, metavar="LEVEL", help="A level of its races; repeat for more."
)
@click.option(
    "--tag", "tag", multiple=True, metavar="LEVEL", help="A level on which tag is played; repeat for more."
)
@click.option("--no-house", is_flag=True, help="Leave the programs of the house out.")
def new(folder: Path, title: str, races: tuple[str, ...], tag: tuple[str, ...], no_house: bool) -> None:
    """Make a league in FOLDER that all users of this machine can enter; you run its matches."""
    from kit.school.game.league.entries import LeagueError
    from kit.school.game.league.league import RACES, TAG, League

    try:
        given = bool(races or tag)
        league = League.make(
            folder, title, races if given else RACES, tag if given else TAG, has_house=not no_house
        )
    except LeagueError as error:
        messages.fail(str(error))
    messages.say(f"To enter it: kit league --folder {league.folder} submit --controller FILE")


@command.command("submit")
@click.option("--controller", help="Controller name, or a Python file with a ROS 2 node.")
@click.option("--agent", help="Name of a training run, or a policy file.")
@click.option("--name", help="Name of the entry (default: that of the file or the run).")
@click.option("--keep", is_flag=True, help="Keep the program that is entered as NAME-1, a rival to beat.")
@click.pass_context
def submit(
    context: click.Context, controller: str | None, agent: str | None, name: str | None, keep: bool
) -> None:
    """Enter a program or an agent, or renew your entry of that name."""
    from kit.school.game.league import entries

    if (controller is None) == (agent is None):
        messages.fail("Give either --controller NAME or --agent RUN.")
    with _open_league(context) as (league, workspace):
        try:
            if controller is not None:
                found = find_controller(controller, workspace.controllers)
                own_name, program = found.name, found.file.read_bytes()
            else:
                own_name = Path(agent or "").stem
                program = entries.program_of_agent(agent or "", workspace.runs)
        except (LookupError, OSError) as error:
            messages.fail(messages.describe_error(error))
        league.programme()
        if keep:
            rival = entries.renew_beside_former(league.folder, name or own_name, program)
            messages.say(f"{rival} is what {name or own_name} was until now.")
        else:
            entries.submit(league.folder, name or own_name, program)
        messages.say(f"{name or own_name} is entered. `kit league run` drives its matches.")


@command.command("withdraw")
@click.argument("name")
@click.pass_context
def withdraw(context: click.Context, name: str) -> None:
    """Take your entry NAME out of the league; its matches count no more."""
    from kit.school.game.league import entries

    with _open_league(context) as (league, _):
        entries.withdraw(league.folder, name)
        messages.say(f"{name} is withdrawn.")


@command.command("run")
@click.option(
    "--level",
    type=click.Choice(["0", "1", "2", "3"]),
    help="How far programs are confined from now on (`kit doctor` lists what this machine has).",
)
@click.option(
    "--house/--no-house",
    default=None,
    help="Whether the programs of the house take part from now on.",
)
@executor_options("Processes", "Where matches are driven.", may_have_none=False)
@click.pass_context
def run(context: click.Context, level: str | None, house: bool | None, executor: JobExecutor) -> None:
    """Drive the matches that are missing. What is interrupted goes on where it was.

    Exit code: 0 all matches are driven; 1 some are not; 2 the league cannot be run.
    """
    with _open_league(context) as (league, _):
        if league.is_mine:
            programme = league.programme()
            confinement = programme.confinement if level is None else Level(int(level))
            has_house = programme.has_house if house is None else house
            league.change(replace(programme, confinement=confinement, has_house=has_house))
        try:
            keys = league.prepare_run()
        except OSError as error:
            messages.fail(messages.describe_error(error))
        jobs = [each for each in league.jobs() if each.key in keys]
        try:
            executor.run(league, keys, _counter(jobs, "driven"))
        except (ExecutorUnavailable, OSError) as error:
            messages.fail(messages.describe_error(error))
        _print_standings(league)
        if left := league.waiting():
            messages.say(f"{counted(len(left), 'job')} left no result: run it again.", err=True)
            raise SystemExit(INCOMPLETE)


def _counter(jobs: Sequence[LeagueJob], word: str) -> Callable[[str], None]:
    """A function that is called with the key of each job that is done, and tells a terminal how many are and how long the rest
    takes. ``word``: what they are then."""
    from kit.learning.training.run_upkeep import format_seconds
    from kit.school.game.league.league import seconds_left

    done: set[str] = set()
    begun_s = time.monotonic()

    def count(key: str) -> None:
        done.add(key)
        left_s = seconds_left(jobs, done, time.monotonic() - begun_s)
        if sys.stderr.isatty() and left_s is not None:
            told = f"{len(done)} of {len(jobs)} {word}, about {format_seconds(left_s)} left"
            click.echo(f"\r{told:<60}", nl=len(done) == len(jobs), err=True)

    return count


@command.command("matches")
@click.argument("name", required=False)
@click.pass_context
def matches(context: click.Context, name: str | None) -> None:
    """List all matches, or those of the entry NAME, with the numbers that `kit league replay` takes."""
    from kit.school.game.league.entries import find_entry
    from kit.school.game.league.league_blocks import matches_table
    from kit.school.game.league.standings import read_standings

    with _open_league(context) as (league, _):
        if name is not None:
            find_entry(league.entries(), name)
        found = read_standings(league)
        table = matches_table(found.matches, name)
        click.echo("\n".join(lines_of([table])) if table.rows else "No match has been driven yet.")


@command.command("replay")
@click.argument("number", type=click.IntRange(1))
@click.pass_context
def replay(context: click.Context, number: int) -> None:
    """Watch match NUMBER of `kit league matches`, with both robots."""
    from kit.school.game.league.league_blocks import match_sentence
    from kit.school.game.league.standings import match_film, read_standings

    with _open_league(context) as (league, _):
        found = read_standings(league).matches
        if number > len(found):
            messages.fail(f"There are only matches 1 to {len(found)}; `kit league matches` lists them.")
        match = found[number - 1]
        terminal = terminal_options.decide()
        if terminal.plain.value:
            click.echo(f"{match_sentence(match)} Watching it needs a full-screen terminal.")
            return

        film = match_film(league, match)

        def make_screen(app: KitApp) -> Screen[None]:
            from kit.tui.screens.match_replay import MatchReplayScreen

            return MatchReplayScreen(app.kit_theme, match, film)

        show_screen(terminal, make_screen)


@command.command("verify")
@click.pass_context
def verify(context: click.Context) -> None:
    """Drive all matches anew with the programs that are entered, and compare them with the results, to the bit.

    Exit code: 0 all are what their programs drive here; 1 some are not; 2 the league cannot be read.
    """
    from kit.school.game.league.verification import differing_jobs

    with _open_league(context) as (league, _):
        found = differing_jobs(league, _counter(league.jobs(), "compared"))
        verdicts = {
            "the programs drive something other than the result shows.": found.differing,
            "driven something else each time, as with random numbers that have no seed: nothing can be compared.": (
                found.unrepeatable
            ),
        }
        for verdict, jobs in verdicts.items():
            for job in jobs:
                names = " against ".join(each.name for each in job.entrants)
                messages.say(f"{job.level.title}, {names}: {verdict}")
        different = len(found.differing) + len(found.unrepeatable)
        messages.say(f"{found.compared} compared, {different} different.")
        if different:
            raise SystemExit(INCOMPLETE)


@command.command("work", hidden=True)
@click.argument("league_folder", type=click.Path(path_type=Path))
@click.option("--shard", help="Share i of n, such as 0/4.")
@click.option("--judgements", type=click.Path(path_type=Path), help="Where judgements are kept.")
@click.option("--judge", is_flag=True, help="Judge results instead.")
def work(league_folder: Path, shard: str | None, judgements: Path | None, judge: bool) -> None:
    """Drive the matches whose keys come on standard input, or a share of all that are missing."""
    from kit.school.game.league.entries import LeagueError
    from kit.school.game.league.league import League

    league = League(league_folder, judgements)
    try:
        if shard is None:
            serve_keys(league.judge_key if judge else league.run_job)
            return
        share = read_shard(shard)
        if share is None:
            messages.fail(f"{shard}: give the share and the number of shares, counting from 0, such as 0/4.")
        for key in league.waiting(share):
            league.run_job(key)
    except LeagueError as error:
        messages.fail(str(error))


def _print_standings(league: League) -> None:
    from kit.school.game.league.league_blocks import standings_table, summary_blocks
    from kit.school.game.league.standings import read_standings

    found = read_standings(league, _print_progress)
    _print_progress(None)
    table = [standings_table(found)] if found.places else []
    click.echo("\n".join(lines_of([*summary_blocks(found), *table])))


def _print_progress(standings: Standings | None) -> None:
    """Shows on a terminal how many results have been run again; None clears it."""
    if sys.stderr.isatty():
        read = (
            "" if standings is None else f"{standings.jobs - standings.unread} of {standings.jobs} run again"
        )
        click.echo(f"\r{read:<40}" + ("\r" if standings is None else ""), nl=False, err=True)
