"""``kit`` alone: opens the start screen, or prints the student's progress and what to type next."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from kit.cli import messages, options, terminal_options
from kit.cli.full_screen import show_screen
from kit.document.blocks import labelled_table
from kit.document.layout import lines_of
from kit.workspace import Workspace, WorkspaceError

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.start import StartScreen

SUGGESTED_COMMANDS: Final = (
    ("kit lesson", "lessons: predict, run, explain, modify, make"),
    ("kit drive", "drive: any map, any controller"),
    ("kit game", "levels, stars, ghosts, races"),
    ("kit league", "your programs and agents against others"),
    ("kit train turn", "train an agent to drive"),
    ("kit layers", "plan a world's collision layers"),
    ("kit quiz", "test what you know; kit quiz --today: questions due today"),
    ("kit progress", "what you have done; export and import it"),
    ("kit --help", "everything else"),
)


@click.command()
@options.seed
@options.workspace
@click.option("--plain", is_flag=True, help="Print where you are and what to type, instead of a full screen.")
@terminal_options.glyphs
@terminal_options.color
def command(seed: int, workspace: Path | None, plain: bool, glyphs: str | None, color: str | None) -> None:
    """Open the kit: a robot to drive with W, A, S and D, and a menu of everything in it.

    Enter continues where you left off; for a new student, that is the first lesson.
    """
    from kit.controllers import prepare_workspace

    try:
        opened_workspace = prepare_workspace(workspace)
    except WorkspaceError as error:
        messages.fail(str(error))
    terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
    if terminal.plain.value:
        click.echo(f"The kit, line by line. {terminal.plain.reason}")
        _print_overview(opened_workspace)
        return

    def make_screen(app: KitApp) -> StartScreen:
        from kit.tui.screens.start import StartScreen
        from kit.tui.student_store import StudentStore

        return StartScreen(app.kit_theme, StudentStore(opened_workspace), seed=seed)

    show_screen(terminal, make_screen)


def _print_overview(opened_workspace: Workspace) -> None:
    from kit.tui.student_store import StudentStore

    store = StudentStore(opened_workspace)
    try:
        overview = store.read_overview()
        notice = store.take_notice()
    finally:
        store.close()
    for line in filter(None, (notice, overview.problem)):
        click.echo(line, err=True)
    entry = overview.going_on
    if entry is not None and entry.progress is not None:
        step = entry.progress.next_step
        where = (
            f", step {step.number}: {step.title}"
            if entry.has_started
            else f". {entry.progress.lesson.summary}"
        )
        click.echo(f"Next lesson: `kit lesson {entry.number}`, {entry.title}{where}")
    if overview.shelf:
        click.echo(f"{overview.done} of {len(overview.shelf)} lessons done.")
    if overview.due:
        click.echo(f"{overview.due} questions are due today: `kit quiz --today`")
    click.echo("")
    click.echo("\n".join(lines_of([labelled_table(SUGGESTED_COMMANDS, indent=2)])))
