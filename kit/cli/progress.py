"""``kit progress``: shows what was done so far; exports everything to one file, and imports it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from kit.cli import options
from kit.plain_text import counted
from kit.school.game.challenges import game_summary
from kit.school.lessons.catalogue import list_lessons
from kit.school.progress import EventKind, ProgressError, ProgressJournal, read_export
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError

TITLE_COLUMNS = 40


@contextmanager
def _open_journal(workspace: Path | None) -> Iterator[ProgressJournal]:
    """Opens the journal; every error of the user's ends the verb with a message."""
    try:
        with options.open_journal(open_workspace(workspace)) as journal:
            yield journal
    except (ProgressError, WorkspaceError, WorldError, FileNotFoundError) as error:
        options.fail(str(error))


@click.group(invoke_without_command=True)
@options.workspace
@click.pass_context
def command(context: click.Context, workspace: Path | None) -> None:
    """Show what you have done, or export and import it.

    \b
    kit progress                   lessons, points, and what is left
    kit progress export ada.json   for another machine or your teacher
    kit progress import ada.json   add what is new; nothing counts twice
    """
    context.obj = workspace
    if context.invoked_subcommand is None:
        with _open_journal(workspace) as journal:
            _show(journal)


@command.command("export")
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@click.pass_obj
def export(workspace: Path | None, file: Path) -> None:
    """Export all your progress to FILE."""
    with _open_journal(workspace) as journal:
        click.echo(f"{file}: {journal.export(file)} entries.")


@command.command("import")
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@click.pass_obj
def import_progress(workspace: Path | None, file: Path) -> None:
    """Import an exported FILE; existing entries stay as they are."""
    with _open_journal(workspace) as journal:
        events = read_export(file)
        new = journal.import_events(events)
        click.echo(f"{file}: {len(events)} entries, {new} of them new.")


@command.command("name")
@click.argument("name")
@click.pass_obj
def name_yourself(workspace: Path | None, name: str) -> None:
    """Set your name, for the leaderboard and your exports."""
    shown = " ".join(name.split())
    if not 1 <= len(shown) <= 40 or not shown.isprintable():
        options.fail("A name has 1 to 40 printable characters.")
    with _open_journal(workspace) as journal:
        journal.add(EventKind.ABOUT, "name", {"value": shown})
        click.echo(f"Your name is {shown}.")


def _show(journal: ProgressJournal) -> None:
    from kit.tui.rows.level_rows import game_progress

    events = journal.events()
    if not events:
        first = list_lessons(events)[0]
        click.echo(f"Nothing yet. Begin with `kit lesson {first.number}`; it takes five minutes.")
        return
    shelf = list_lessons(events)
    for each in shelf:
        progress = each.progress
        if progress is None:
            click.echo(
                f"{each.number:<3} {each.title:<{TITLE_COLUMNS}} cannot be read; `kit lesson {each.number}` says why"
            )
            continue
        exercises = progress.lesson.exercises
        passed = sum(exercise.name in progress.passed_exercises for exercise in exercises)
        bar = "".join("#" if progress.is_step_completed(step) else "." for step in progress.lesson.steps)
        tries = sum(progress.attempt_counts.values())
        checks = f"{tries} checks" if tries else ""
        click.echo(
            f"{each.number:<3} {each.title:<{TITLE_COLUMNS}} {bar:<12} {passed}/{len(exercises)} exercises  {checks}"
        )
    finished = sum(each.is_completed for each in shelf)
    click.echo(f"\n{counted(finished, 'lesson')} done. `kit quiz --scores` shows the quiz.\n\nThe game")
    for line in game_progress(game_summary(events)):
        click.echo("".join(text for text, _ in line).rstrip())
