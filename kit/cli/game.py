"""``kit game``: levels, stars, time trials and the leaderboard."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import messages, opening, options, terminal_options
from kit.cli.full_screen import show_levels, show_screen
from kit.cli.lazy_group import NamesGroup, or_command
from kit.cli.shared_game import guest, host
from kit.controllers import find_controller, prepare_workspace
from kit.document.blocks import Block, CellStyle, Column, Table, Text, labelled_table
from kit.document.layout import lines_of
from kit.document.rows import row_text
from kit.host.private_folder import private_folder
from kit.plain_text import counted
from kit.school.progress import ProgressError
from kit.workspace import Workspace, WorkspaceError
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.learning.policies.policy import Policy
    from kit.run.recording import Recording
    from kit.school.game.levels import GameLevel
    from kit.school.game.medal import Medal
    from kit.school.game.player_progress import DriverFacts, GameSummary
    from kit.school.game.race import DriverKind, RaceFinish
    from kit.school.progress import ProgressJournal
    from kit.tui.app import KitApp
    from kit.tui.screens.lesson_drive import ReplayScreen

STAR, NO_STAR = "*", "."


@contextmanager
def _open_journal(workspace: Path | None) -> Iterator[tuple[ProgressJournal, Workspace]]:
    """Opens the journal and the workspace; every error of the user's ends the verb with a message."""
    from kit.school.game.leaderboard import LeaderboardError
    from kit.school.game.levels import UnknownLevel

    try:
        opened_workspace = prepare_workspace(workspace)
        with opening.open_journal(opened_workspace) as journal:
            yield journal, opened_workspace
    except (
        ProgressError,
        WorkspaceError,
        WorldError,
        UnknownLevel,
        LeaderboardError,
        FileNotFoundError,
    ) as error:
        messages.fail(str(error))


def _read_summary(journal: ProgressJournal) -> GameSummary:
    from kit.school.game.challenges import game_summary
    from kit.school.game.levels import all_levels
    from kit.school.game.player_progress import completed_lessons

    events = journal.events()
    return game_summary(events, completed_lessons(all_levels(), events))


def _find_level(name: str) -> GameLevel:
    """The level of a name. Ends the verb for the maze of a day that has not come; raises as ``find_playable_level``."""
    from kit.school.game.daily import DailyLevel, find_playable_level, today
    from kit.school.game.levels import UnknownLevel

    try:
        level = find_playable_level(name)
    except UnknownLevel as error:
        messages.fail(or_command(str(error)))
    if isinstance(level, DailyLevel) and level.day > today():
        messages.fail(f"{level.title} comes on its day.")
    return level


def _require_open(journal: ProgressJournal, level: GameLevel) -> None:
    """Ends the verb with what opens the level, where it is not open yet; levels of a day or a task always are."""
    from kit.tui.rows.level_rows import opens_after

    if any(each.level == level and not each.is_open for each in _read_summary(journal).levels):
        messages.fail(f"{level.title} {opens_after(level)}. `kit game --plain` lists which levels are open.")


@click.group(cls=NamesGroup, invoke_without_command=True)
@options.workspace
@click.option("--plain", is_flag=True, help="Print the list as text instead of a full screen.")
@click.pass_context
def command(context: click.Context, workspace: Path | None, plain: bool) -> None:
    """Play levels, from the first drive to two wheelchairs; race ghosts, win medals, join a leaderboard.

    \b
    kit game                              list the levels and your stars
    kit game play first-drive             drive a level by hand
    kit game race the-maze --controller my_controller.py
    kit game race left-turn --agent my_run   race an agent that you trained
    kit task new mine --level left-turn   to train an agent for a level
    kit game race mine/task.yaml --agent my_run   use your own task
    kit game replay left-turn             replay your best drive
    kit game daily                        today's maze, the same for everyone
    kit game puzzle                       puzzles without driving
    kit game host two-doors --tag         two players: a race or tag
    kit game leaderboard                  the best times on this machine

    A level can be driven once a level before it is finished or the lesson that opens it too is completed; the level of
    the day is always open. Driving by hand, your program and your agent win separate medals, by ladders
    of their own: bronze, silver, gold, master and, quicker than the reference drive, the record. A drive with a
    bump, or in which a pair is apart for too long, gets bronze at best. A program or an agent drives from five
    starts (shifted, with noise, other traffic), and the middle drive counts. Each extra rule earns a star: no bump, no stop, one sensor, few lines of
    code, few training steps. The kit's own controllers demonstrate and earn nothing. A task used as a level (its first
    case) has no reference drive and so no medals; it has your time, your best time and its ghost. KIT_BELL=1 rings
    the bell for a new medal.
    """
    context.obj = workspace
    if context.invoked_subcommand is not None:
        return
    with _open_journal(workspace) as (journal, opened_workspace):
        terminal = terminal_options.decide(plain=plain)
        if not terminal.plain.value:
            show_levels(journal, opened_workspace, terminal)
        _print_levels(_read_summary(journal))


@command.command("play")
@click.argument("level")
@click.option("--plain", is_flag=True, help="Print lines of text instead of a full screen.")
@click.pass_obj
def play(workspace: Path | None, level: str, plain: bool) -> None:
    """Drive LEVEL by hand. LEVEL is a level's name or number, or a task's file or name."""
    from kit.school.game.drive_records import begin_run
    from kit.school.game.race import DriverKind

    with _open_journal(workspace) as (journal, opened_workspace):
        chosen = _find_level(level)
        terminal = terminal_options.decide(plain=plain)
        if not terminal.plain.value:
            show_levels(journal, opened_workspace, terminal, chosen)
        _require_open(journal, chosen)
        click.echo(f"{chosen.title}. {chosen.story} {chosen.hint}")
        is_practice = begin_run(journal, chosen)
        drive = _drive_line_by_line(chosen, opened_workspace)
        _record_drive(journal, opened_workspace, chosen, DriverKind.HAND, [drive], is_practice=is_practice)


command.taker = play


@command.command("race")
@click.argument("level")
@click.option("--controller", help="Controller name, or a Python file with a ROS 2 node.")
@click.option("--agent", help="Name of a training run, or a policy file.")
@click.pass_obj
def race_(workspace: Path | None, level: str, controller: str | None, agent: str | None) -> None:
    """Race a program or a trained agent on LEVEL. LEVEL is a level's name or number, or a task's file, folder or name.

    A program gets the same parameters as with `kit run`: home, model, models, world,
    target [x, y] and target_radius. On a level with several targets, target is the
    first, and targets [x1, y1, x2, y2, ...] lists all in order, lap by lap. Where a
    leader is followed, leader_frame is its frame on /tf.

    On a level with medals it drives five times, and the middle drive counts: once from
    the level's own start, and four times from starts that are drawn anew for each race,
    some centimetres and degrees off, with a robot that veers, laser noise, and traffic
    that is elsewhere.
    """
    from kit.learning.policies.policy import PolicyError
    from kit.learning.training.run_config import RunError
    from kit.school.game.drive_records import begin_run
    from kit.school.game.player_progress import facts_of_program
    from kit.school.game.race import DriverKind, agent_controller, race_from_all_starts

    if (controller is None) == (agent is None):
        messages.fail("Give either --controller NAME or --agent RUN. To drive by hand, use `kit game play`.")
    with _open_journal(workspace) as (journal, opened_workspace):
        chosen = _find_level(level)
        _require_open(journal, chosen)
        try:
            if controller is not None:
                driver, program = (
                    DriverKind.PROGRAM,
                    find_controller(controller, opened_workspace.controllers),
                )
                facts = facts_of_program(program.file)
                is_practice = begin_run(journal, chosen)
                drives = race_from_all_starts(chosen, program, on_second=_print_race_time)
            else:
                driver, (policy, facts) = DriverKind.AGENT, _find_policy(agent or "", opened_workspace)
                with agent_controller(policy) as program:
                    is_practice = begin_run(journal, chosen)
                    drives = race_from_all_starts(chosen, program, on_second=_print_race_time)
        except (LookupError, PolicyError, RunError) as error:
            messages.fail(str(error))
        finally:
            _print_race_time(0, None)
        _record_drive(journal, opened_workspace, chosen, driver, drives, facts, is_practice)


@command.command("daily")
@click.option("--controller", help="Controller that drives it, by name or file (default: you drive).")
@click.option("--plain", is_flag=True, help="Print lines of text instead of a full screen.")
@click.pass_context
def daily(context: click.Context, controller: str | None, plain: bool) -> None:
    """Drive today's maze, which is the same for everyone."""
    from kit.school.game.daily import daily_level, has_run, streak, today

    level = daily_level(today())
    if controller is None and not terminal_options.decide(plain=plain).plain.value:
        context.invoke(
            play, level=level.id, plain=plain
        )  # the screen tells it all, and what is true at its end
        return
    click.echo(f"{level.title}. {level.hint}")
    with _open_journal(context.obj) as (journal, _):
        days = streak(journal.events(), today())
        has_begun = has_run(journal.events(subject=level.id), level)
    if days:
        click.echo(f"{counted(days, 'day')} in a row.")
    elif not has_begun:
        click.echo("Finish it today to start a streak.")
    if controller is None:
        context.invoke(play, level=level.id, plain=True)
    else:
        context.invoke(race_, level=level.id, controller=controller, agent=None)


@command.command("puzzle")
@click.argument("name", required=False)
@click.argument("answer", required=False)
@click.pass_obj
def challenge(workspace: Path | None, name: str | None, answer: str | None) -> None:
    """Solve puzzles without driving. Break a reward, beat a layer plan, train within a budget, mount the fewest
    lasers, or repair a launch file against the clock.

    Without NAME, list them; with NAME, show one. ANSWER depends on the puzzle: its file, what the file would hold
    (moves, numbers), or the name of a training run. A better answer earns a better medal.
    """
    from kit.school.game.challenge import AnswerError, AnswerSubmission
    from kit.school.game.challenges import (
        all_challenges,
        answers_folder,
        challenge_medals,
        find_challenge,
        prepare_answer,
        record_judgement,
    )
    from kit.school.game.medal import Medal
    from kit.school.game.shared_answers import share_answer
    from kit.school.lessons.reading import lesson_number

    with _open_journal(workspace) as (journal, opened_workspace):
        if name is None:
            medals = challenge_medals(journal.events())
            rows = [
                (_medal_letter(medals.get(each.id, Medal.NONE)), each.id, f"{each.title}. {each.task_text}")
                for each in all_challenges()
            ]
            click.echo("\n".join(lines_of([labelled_table(rows, indent=2)])))
            return
        try:
            chosen = find_challenge(name)
            clock, seconds = chosen.task.clock, math.inf
            if clock is not None:
                file, seconds = prepare_answer(journal, chosen, answers_folder(opened_workspace))
            if answer is None:
                click.echo(
                    f"{chosen.title}. {chosen.story}\n{chosen.written_task}\nLesson {lesson_number(chosen.lesson)} prepares you for it."
                )
                for line in chosen.task.lines():
                    click.echo(line)
                if clock is not None:
                    click.echo(
                        f"Your file: {file}\nGold until {clock[0]:.0f} s, silver until {clock[1]:.0f} s; the clock is at {seconds:.0f} s."
                    )
                click.echo(f"To hand in: kit game puzzle {chosen.id} ANSWER")
                return
            answer = chosen.task.parse_answer(answer)
            judgement = chosen.task.judge(AnswerSubmission(answer, opened_workspace.runs, seconds))
        except (LookupError, AnswerError, OSError) as error:
            messages.fail(messages.describe_error(error))
        record_judgement(journal, chosen, judgement)
        share_answer(chosen, answer, judgement)
        click.echo(f"{judgement.text}\n  {judgement.medal.title}")


@command.command("replay")
@click.argument("level")
@click.option(
    "--driver",
    type=click.Choice(["hand", "program", "agent", "reference"]),
    help="Drive to show (default: your fastest, or the reference if you have none).",
)
@click.pass_obj
def replay(workspace: Path | None, level: str, driver: str | None) -> None:
    """Replay your best drive of LEVEL, or the reference drive."""
    from kit.run.recording import RecordingError, load_recording
    from kit.school.game.daily import has_run, is_of_today
    from kit.school.game.ghosts import ghost_file, load_ghosts
    from kit.school.game.race import DriverKind
    from kit.school.game.references import reference_recording
    from kit.school.game.starts import film_scenario

    with _open_journal(workspace) as (journal, opened_workspace):
        chosen = _find_level(level)
        name = driver or next((each.name for each in load_ghosts(opened_workspace, chosen)), "reference")
        if name == "reference" and is_of_today(chosen) and not has_run(journal.events(), chosen):
            messages.fail("Drive today's maze first: finding the way is what it is about.")
        try:
            recording = (
                reference_recording(chosen)
                if name == "reference"
                else load_recording(ghost_file(opened_workspace, chosen, DriverKind(name)))
            )
        except FileNotFoundError:
            messages.fail(f"There is no drive of {chosen.title} {DriverKind(name).phrase} yet.")
        except (RecordingError, OSError) as error:
            messages.fail(f"This drive cannot be shown: {error}")
        if recording is None:
            messages.fail(f"{chosen.title} has no reference drive.")
        drive, scenario = recording, film_scenario(chosen, recording.seed)
        who = name if name == "reference" else DriverKind(name).phrase
        terminal = terminal_options.decide()
        if terminal.plain.value:
            seconds = drive.ticks * drive.step_size
            click.echo(f"{chosen.title}, {who}: {seconds:.2f} s. Replaying it needs a full-screen terminal.")
            return

        def make_screen(app: KitApp) -> ReplayScreen:
            from kit.tui.screens.lesson_drive import ReplayScreen

            return ReplayScreen(app.kit_theme, scenario, drive, who)

        show_screen(terminal, make_screen)


@command.command("leaderboard")
@click.pass_obj
def leaderboard(workspace: Path | None) -> None:
    """Show the leaderboard of this machine: medals, then best times. Every drive on it is run again and judged here."""
    from kit.school.game.leaderboard import has_joined, leaderboard_folder, read_entries, standings
    from kit.tui.rows.leaderboard_rows import leaderboard_standings, leaderboard_times

    with _open_journal(workspace) as (_progress, _):
        found = read_entries(leaderboard_folder())
        click.echo("\n".join(lines_of([*leaderboard_standings(standings(found)), leaderboard_times(found)])))
        if not has_joined(leaderboard_folder()):
            messages.say(
                "You are not on it. `kit game join` adds your name and drives; `kit game leave` removes them."
            )


@command.command("join")
@click.option("--name", help="Your name on it (default: the one set with `kit progress name`).")
@click.pass_obj
def join(workspace: Path | None, name: str | None) -> None:
    """Join the leaderboard. All users of this machine can then see your name and your best drives."""
    from kit.school.game.drive_records import join_leaderboard
    from kit.school.game.leaderboard import leaderboard_folder

    with _open_journal(workspace) as (journal, opened_workspace):
        player_name = name or journal.student_name
        if not player_name or not player_name.isprintable():
            messages.fail("Give a name: `kit game join --name Ada`.")
        join_leaderboard(journal, opened_workspace, player_name)
        messages.say(
            f"{player_name} is on the leaderboard of this machine ({leaderboard_folder()}). `kit game leave` undoes it."
        )


@command.command("leave")
@click.pass_obj
def leave_(workspace: Path | None) -> None:
    """Remove your name and drives from the leaderboard."""
    from kit.school.game.leaderboard import leaderboard_folder, remove_own_entry

    with _open_journal(workspace):
        remove_own_entry(leaderboard_folder())
        click.echo("You are not on the leaderboard.")


command.add_command(host)
command.add_command(guest)


def _drive_line_by_line(level: GameLevel, opened_workspace: Workspace) -> tuple[RaceFinish, Recording]:
    """Lets the player drive with lines of text, in simulated time. Ends the verb where nothing was driven."""
    from kit.cli.plain import PlainSession, run_plain_session
    from kit.run.recording import RecordingError, load_recording
    from kit.run.recording_file import RecordingFile
    from kit.school.game.race import RaceReferee, judge_recording
    from kit.school.game.starts import OWN_SEED

    scenario = level.find_scenario()
    referee = RaceReferee(level, scenario)

    def report() -> str:
        finish = referee.finish
        if finish.foul:
            return f"it does not count: {finish.foul}"
        if finish.reached:
            return f"finished after {finish.seconds:.2f} s; quit ends the drive"
        charge = f"{max(0.0, referee.battery.charge):.1f} m of charge" if level.conditions.charge else ""
        return ", ".join(filter(None, (referee.objective.progress, charge)))

    with private_folder() as folder:
        file = Path(folder, "drive.npz")
        run_plain_session(
            PlainSession(
                scenario,
                find_controller("teleop", opened_workspace.controllers),
                seed=OWN_SEED,
                folder=opened_workspace.controllers,
                record=RecordingFile(file),
                prints_file=False,
                observer=referee,
                report=report,
            )
        )
        try:
            recording = load_recording(file)
            return judge_recording(level, recording), recording
        except (RecordingError, OSError, ValueError) as error:
            messages.fail(f"The drive was not saved: {error}")


def _print_levels(summary: GameSummary) -> None:
    from kit.school.game.levels import all_worlds
    from kit.school.game.medal import Medal
    from kit.school.game.player_progress import ExtraRule
    from kit.school.game.race import DriverKind
    from kit.tui.rows.level_rows import medal_counts

    blocks: list[Block] = [
        Text(
            "Of each level: its number; the medals by hand, by your program and by your agent (B, S, G, M, R); "
            "the stars of five extra rules; its name; your best times, or what opens it."
        )
    ]
    found = summary.levels
    for world in all_worlds():
        rows = []
        for number, each in enumerate(found, 1):
            if each.level.world != world.id:
                continue
            level = each.level
            medals = "".join(_medal_letter(each.medals.get(driver, Medal.NONE)) for driver in DriverKind)
            stars = f"{STAR * each.star_count:{NO_STAR}<{len(ExtraRule)}}"
            times = ", ".join(f"{driver.phrase} {time:.2f} s" for driver, time in each.best_times.items())
            lesson = f", or after lesson {level.lesson_number}" if level.lesson_number else ""
            state = times if each.is_open else f"opens after {' or '.join(level.opened_by)}{lesson}"
            rows.append((str(number), medals, stars, level.id, state))
        columns = (Column(""), *[Column("", CellStyle.TEXT)] * 4)
        blocks.append(Table(world.id, f"{world.title}: {world.story}", columns, tuple(rows), indent=1))
    won = sum(medal is not Medal.NONE for medal in summary.challenges)
    challenges = f"Puzzles: {won} of {len(summary.challenges)} with a medal; `kit game puzzle` lists them."
    ways = f"{medal_counts(summary)}. `kit game play NAME` drives a level by hand."
    click.echo("\n".join(lines_of([*blocks, Text(challenges), Text(ways)])))


def _medal_letter(medal: Medal) -> str:
    """The first letter of a medal."""
    from kit.school.game.medal import Medal

    return NO_STAR if medal is Medal.NONE else medal.title[0].upper()


def _record_drive(
    journal: ProgressJournal,
    opened_workspace: Workspace,
    level: GameLevel,
    driver: DriverKind,
    drives: list[tuple[RaceFinish, Recording]],
    facts: DriverFacts | None = None,
    is_practice: bool = False,
) -> None:
    """Records a drive, or a program's drives from all starts, and prints what it earned."""
    from kit.school.game.daily import DAILY_PREFIX
    from kit.school.game.drive_records import record_drive
    from kit.school.game.ordinary_drives import ordinary_drives
    from kit.school.game.player_progress import BY_HAND
    from kit.school.game.references import reference_seconds
    from kit.tui.rows.drive_end_rows import REPLACES, RUN_OF_THE_DAY, how_it_ended
    from kit.tui.rows.ladder_rows import ladder_rows
    from kit.tui.rows.level_rows import starts_rows

    record = record_drive(
        journal, opened_workspace, level, driver, drives, facts or BY_HAND, is_practice=is_practice
    )
    finishes = [each for each, _ in drives]
    finish = finishes[record.counts]
    for sentence in how_it_ended(finishes, record.counts, was_watched=False):
        click.echo(f"{level.title}: {sentence}")
    for each in starts_rows(finishes, record.counts):
        click.echo(row_text(each))
    if record.is_shipped:
        click.echo("The kit's own controller drove: it demonstrates the level and earns nothing.")
    elif record.is_practice:
        click.echo("Practice: the first run of the day has counted.")
    elif level.has_medals:
        click.echo(f"  {record.medal.title}")
    if finish.reached and level.ending:
        click.echo(level.ending)
    for rule in record.rules:
        click.echo(f"  {STAR} {rule.description(level)}")
    if record.previous_best is not None and finish.reached:
        click.echo(f"Your best before: {record.previous_best:.2f} s.")
    if record.is_best:
        messages.say(
            f"Your best so far {driver.phrase}; to replay it: kit game replay {level.command_name} --driver {driver}"
        )
    if record.replaces:
        click.echo(f"The board: {REPLACES}.")
    reference = reference_seconds(level)
    if reference is not None:
        seconds = finish.seconds if finish.reached else None
        for each in ladder_rows(driver, reference, seconds, ordinary_drives(level, [driver])):
            click.echo(row_text(each))
    for opened in record.unlocked:
        click.echo(f"Opened: {opened.title} ({opened.id}).")
    if record.belt:
        click.echo(f"The {record.belt} belt of this world is yours.")
    if level.id.startswith(DAILY_PREFIX) and not is_practice:
        click.echo(f"Today's maze: {RUN_OF_THE_DAY}.")
    if record.streak:
        click.echo(f"Today's maze: {counted(record.streak, 'day')} in a row.")
    if finish.failure is not None:
        raise SystemExit(1)


def _find_policy(agent: str, opened_workspace: Workspace) -> tuple[Policy, DriverFacts]:
    """The policy of a training run or a file, and what is known of its training."""
    from kit.learning.policies.policy_file import load_policy
    from kit.learning.training.run_folders import find_run
    from kit.school.game.player_progress import DriverFacts

    file = Path(agent)
    if file.is_file():
        return load_policy(file), DriverFacts()
    run = find_run(opened_workspace.runs, agent)
    return run.policy(), DriverFacts(training_steps=run.summary().steps)


def _print_race_time(start: int, seconds: float | None) -> None:
    """Shows the number of the start and the race's time on a terminal; None clears it."""
    if sys.stderr.isatty():
        text = "" if seconds is None else f"start {start}: {seconds:.0f} s"
        click.echo(f"\r{text:<24}" + ("\r" if seconds is None else ""), nl=False, err=True)
