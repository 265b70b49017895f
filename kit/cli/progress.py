"""``kit progress``: shows what was done so far; exports everything to one file, and imports it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

import click

from kit.cli import messages, opening, options
from kit.cli.lazy_group import HintingGroup
from kit.document.blocks import Block, Cell, CellStyle, Column, Table, Text
from kit.document.layout import lines_of
from kit.document.rows import row_text
from kit.plain_text import counted
from kit.school.badges import badge_table, badges, streak
from kit.school.game.challenges import game_summary
from kit.school.lessons.catalogue import LessonEntry, list_lessons
from kit.school.lessons.reading import read_units
from kit.school.progress import EventKind, ProgressError, ProgressJournal
from kit.school.progress_export import read_export
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError


@contextmanager
def _open_journal(workspace: Path | None) -> Iterator[ProgressJournal]:
    """Opens the journal; every error of the user's ends the verb with a message."""
    try:
        with opening.open_journal(open_workspace(workspace)) as journal:
            yield journal
    except (ProgressError, WorkspaceError, WorldError, FileNotFoundError) as error:
        messages.fail(str(error))


@click.group(cls=HintingGroup, invoke_without_command=True)
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
            _print_progress(journal)


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
        click.echo(f"{file}: {counted(len(events), 'entry')}, {new} of them new.")


@command.command("name")
@click.argument("name")
@click.pass_obj
def name_yourself(workspace: Path | None, name: str) -> None:
    """Set your name, for the leaderboard and your exports."""
    shown = " ".join(name.split())
    if not 1 <= len(shown) <= 40 or not shown.isprintable():
        messages.fail("A name has 1 to 40 printable characters.")
    with _open_journal(workspace) as journal:
        journal.add(EventKind.ABOUT, "name", {"value": shown})
        click.echo(f"Your name is {shown}.")


def _print_progress(journal: ProgressJournal) -> None:
    from kit.tui.rows.level_rows import game_progress

    events = journal.events()
    if not events:
        first = list_lessons(events)[0]
        click.echo(f"Nothing yet. Begin with `kit lesson {first.number}`; it takes five minutes.")
        return
    shelf = list_lessons(events)
    finished = sum(each.is_completed for each in shelf)
    days = streak(events, datetime.now().astimezone().date())
    won = badges(shelf, read_units(), days, events)
    blocks: list[Block] = [
        _lessons_table(shelf),
        Text(f"{counted(finished, 'lesson')} done. `kit quiz --scores` shows the quiz."),
        Text(f"{counted(sum(each.is_earned for each in won), 'badge')}. {days.describe()}"),
    ]
    if any(each.done for each in won):
        blocks.append(badge_table([each for each in won if each.done]))
    blocks.append(Text("The game"))
    click.echo("\n".join([*lines_of(blocks), *map(row_text, game_progress(game_summary(events)))]))


def _lessons_table(shelf: Sequence[LessonEntry]) -> Table:
    """How far each lesson is: its steps, its exercises and how often they were checked."""
    columns = (
        Column("", CellStyle.TEXT),
        Column("lesson", CellStyle.TEXT),
        Column("steps", CellStyle.TEXT),
        Column("exercises"),
        Column("checks"),
    )
    return Table("lessons", "", columns, tuple(map(_lesson_cells, shelf)), is_ruled=False)


def _lesson_cells(entry: LessonEntry) -> tuple[Cell, ...]:
    progress = entry.progress
    if progress is None:
        return entry.number, entry.title, f"cannot be read: see kit lesson {entry.number}", "", ""
    exercises = progress.lesson.exercises
    passed = sum(exercise.name in progress.passed_exercises for exercise in exercises)
    bar = "".join("#" if progress.is_step_completed(step) else "." for step in progress.lesson.steps)
    tries = sum(progress.attempt_counts.values())
    return entry.number, entry.title, bar, f"{passed} of {len(exercises)}", tries or ""
