"""``kit watch``: follows a training on the full screen or line by line."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import learning_options, options
from kit.cli.full_screen import run_screen

if TYPE_CHECKING:
    from kit.learning.training.events import EventReader
    from kit.learning.training.runs import TrainingRun
    from kit.tui.app import KitApp
    from kit.tui.screens.training import TrainingScreen
    from kit.tui.terminal import TerminalDecision

PROGRESS_INTERVAL_S = 2.0
"""Shortest time between two lines of progress; other events are all printed."""


@click.command()
@click.argument("run", required=False)
@click.option("--once", is_flag=True, help="Tell what has happened so far, and end.")
@options.workspace
@learning_options.plain
@options.glyphs
@options.color
def command(
    run: str | None, once: bool, workspace: Path | None, plain: bool, glyphs: str | None, color: str | None
) -> None:
    """Watch RUN, by default the last one: its curve, how its episodes end, the robot with its newest policy.

    Ctrl-C ends the watching, not the training. RUN may also be a game that somebody hosts on this machine with
    `kit game host`.
    """
    from kit.learning.training.runs import find_run

    if run is not None and not once and _is_hosted(run, workspace):
        from kit.cli.shared_game import join_shared_game

        join_shared_game(run, None, plays=False, plain=plain)
    with learning_options.explained_errors():
        found = find_run(learning_options.runs_folder(workspace), run)
        found.config()
        terminal = options.terminal(plain=plain or once, glyphs=glyphs, color=color)
        if terminal.plain.value:
            follow(found, once=once)
        else:
            open_training_screen(found, terminal)


def _is_hosted(name: str, workspace: Path | None) -> bool:
    """Whether a game of that name is hosted, and no training has it."""
    from kit.learning.training.runs import RunError, find_run
    from kit.school.game.shared_sockets import SharedGameError, find_game, games_folder

    try:
        find_game(games_folder(), name)
    except SharedGameError:
        return False
    try:
        find_run(learning_options.runs_folder(workspace), name)
    except RunError:
        return True
    return False


def open_training_screen(run: TrainingRun, terminal: TerminalDecision) -> None:
    """Opens the training screen; exit code 1 if the training has failed by the time it is left."""

    def make_screen(app: KitApp) -> TrainingScreen:
        from kit.tui.screens.training import TrainingScreen

        return TrainingScreen(app.kit_theme, run)

    screen, code = run_screen(terminal, make_screen)
    if screen.state == "interrupted" and run.last_log_line:
        click.echo(run.last_log_line)
    click.echo(screen.farewell)
    if code or screen.state == "failed":
        raise SystemExit(code or 1)


def follow(run: TrainingRun, *, once: bool = False, reader: EventReader | None = None) -> None:
    """Prints a run's events as they come, until its training has ended; exit code 1 if it failed.

    ``reader``: of its events, if not all of them.
    """
    from kit.learning.training.events import EventReader, TrainingEnded, TrainingProgress
    from kit.learning.training.run_text import format_event

    reader = reader or EventReader(run.events_file)
    printed_at, ended = -PROGRESS_INTERVAL_S, None
    try:
        while True:
            is_active = run.is_active  # asked first: whatever is written before the end is read below
            for event in reader.read_new():
                if isinstance(event, TrainingProgress):
                    if event.seconds - printed_at < PROGRESS_INTERVAL_S:
                        continue
                    printed_at = event.seconds
                ended = event if isinstance(event, TrainingEnded) else None
                click.echo(format_event(event))
            if once or not is_active:
                break
            time.sleep(0.1)
    except KeyboardInterrupt:
        click.echo(
            f"\n{run.name} goes on training. `kit watch {run.name}` looks again, `kit runs {run.name} --stop` stops it."
        )
        return
    if ended is None:
        if not once or not run.is_active:
            if run.last_log_line:
                click.echo(run.last_log_line)
            click.echo(
                f"{run.name} was interrupted. `kit train --resume {run.name}` goes on from its last checkpoint."
            )
    elif ended.how == "failed":
        raise SystemExit(1)
    elif not once:
        click.echo(f"`kit evaluate {run.name}` tests the policy that was kept.")
