"""Opens what a verb works on: the workspace, the student's journal, a recording's file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli.messages import describe_os_error, fail
from kit.plain_text import escape_controls
from kit.workspace import Workspace, WorkspaceError, open_workspace

if TYPE_CHECKING:
    from kit.run.recording_file import RecordingFile
    from kit.school.progress import ProgressJournal


def open_existing_workspace(folder: Path | None) -> Workspace:
    """Opens the workspace without making it; ends the verb where that fails."""
    try:
        return open_workspace(folder, make=False)
    except WorkspaceError as error:
        fail(str(error))


def open_journal(workspace: Workspace) -> ProgressJournal:
    """The student's journal; prints on standard error what it says of a damaged file. Raises ProgressError."""
    from kit.school.progress import ProgressJournal

    journal = ProgressJournal(workspace.folder)
    if journal.notice:
        click.echo(journal.notice, err=True)
    return journal


def open_recording_file(file: Path | None) -> RecordingFile | None:
    """Opens the file of ``--record``, and says what was restored in its folder; ends the verb where it cannot be written."""
    if file is None:
        return None
    from kit.run.recording_file import RecordingFile

    try:
        opened = RecordingFile(file)
    except OSError as error:
        fail(describe_os_error(error))
    for notice in opened.notices:
        click.echo(escape_controls(notice), err=True)
    return opened
