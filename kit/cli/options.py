"""Options that several verbs share; errors of the user's end a verb with one clear line and exit code 2."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from kit.cli.existing_path import ExistingPath
from kit.plain_text import escape_controls
from kit.tui.terminal import (
    COLOUR_CHOICES,
    GLYPH_CHOICES,
    THEME_CHOICES,
    THEME_VARIABLE,
    TerminalDecision,
    TerminalFacts,
    TerminalOptions,
    decide_terminal,
)
from kit.workspace import Workspace, WorkspaceError, open_workspace

if TYPE_CHECKING:
    from kit.run.recording_file import RecordingFile
    from kit.school.progress import ProgressJournal
from kit.cli.messages import describe_os_error, fail, say

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

Storage = Literal["mcap", "sqlite3"]
"""Kinds of bags."""


def environment_variable(text: str) -> tuple[str, str]:
    """Name and value of ``--env NAME[=VALUE]``; without a value that of this process."""
    name, given, value = text.partition("=")
    if not given and name not in os.environ:
        raise click.UsageError(f"The environment variable {name} is not set; use --env {name}=VALUE.")
    return name, value if given else os.environ[name]


def open_journal(workspace: Workspace) -> ProgressJournal:
    """The student's journal; prints on standard error what it says of a damaged file. Raises ProgressError."""
    from kit.school.progress import ProgressJournal

    journal = ProgressJournal(workspace.folder)
    if journal.notice:
        click.echo(journal.notice, err=True)
    return journal


def recording_file(file: Path | None) -> RecordingFile | None:
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


def open_existing_workspace(folder: Path | None) -> Workspace:
    """Opens the workspace without making it; ends the verb where that fails."""
    try:
        return open_workspace(folder, make=False)
    except WorkspaceError as error:
        fail(str(error))


def terminal(*, plain: bool = False, glyphs: str | None = None, color: str | None = None) -> TerminalDecision:
    """Decides what this terminal can show."""
    glyph_choice = next((choice for choice in GLYPH_CHOICES if choice == glyphs), None)
    return decide_terminal(os.environ, TerminalFacts.here(), TerminalOptions(plain, glyph_choice, color))


def full_screen(
    subject: str, instead: str = "", *, glyphs: str | None = None, color: str | None = None
) -> TerminalDecision:
    """Decides what this terminal can show; ends the verb with a message where that is no full screen.

    ``subject``: what needs one. ``instead``: what does the same line by line, in a sentence.
    """
    found = terminal(glyphs=glyphs, color=color)
    if found.plain.value:
        fail(f"{subject} needs a full-screen terminal. {found.plain.reason}" + (instead and f"\n{instead}"))
    return found


workspace: Decorator = click.option(
    "--workspace",
    type=click.Path(file_okay=False, path_type=Path),
    help="Workspace folder (default: $KIT_WORKSPACE, else ~/robot-kit).",
)
seed: Decorator = click.option(
    "--seed",
    type=click.IntRange(0, 2**63 - 1),
    default=0,
    show_default=True,
    help="Random seed; the same seed gives the same run.",
)


def controller_option(default: str) -> Decorator:
    """The option ``--controller`` with this default."""
    return click.option(
        "--controller",
        default=default,
        show_default=True,
        help="Controller name, or a Python file with a ROS 2 node.",
    )


controller: Decorator = controller_option("random_walk")
case: Decorator = click.option(
    "--case", help="Start and target, for a map with several; `kit maps MAP` lists them."
)
glyphs: Decorator = click.option(
    "--glyphs", type=click.Choice(GLYPH_CHOICES), help="Characters used to draw the world."
)


def _choose_theme(context: click.Context, parameter: click.Parameter, value: str | None) -> None:
    """The environment is where the terminal's decision and other programs of the kit find it."""
    if value is not None:
        os.environ[THEME_VARIABLE] = value


def color(function: Callable[..., Any]) -> Callable[..., Any]:
    """The options ``--color`` and ``--theme``; the second is not handed to the verb."""
    theme = click.option(
        "--theme",
        type=click.Choice(THEME_CHOICES),
        expose_value=False,
        callback=_choose_theme,
        help=f"Colour theme; {THEME_VARIABLE} sets it too. `terminal` uses your terminal's 16 colours.",
    )
    count = click.option(
        "--color", type=click.Choice(COLOUR_CHOICES), help="Number of colours; NO_COLOR is respected."
    )
    return count(theme(function))


root: Decorator = click.option(
    "--root",
    type=ExistingPath(file_okay=False, path_type=Path),
    help="Folder that the world file may read (default: its own).",
)
storage: Decorator = click.option(
    "-s",
    "--storage",
    type=click.Choice(["mcap", "sqlite3"]),
    default="mcap",
    show_default=True,
    help="Bag format: mcap for ROS 2 Iron and later, sqlite3 for Humble.",
)


def explain_storage(kind: Storage) -> None:
    """Prints which ROS 2 distributions read such a bag."""
    if kind == "mcap":
        say(
            "The bag is in MCAP format. ROS 2 Humble needs a plugin to read it; `-s sqlite3` needs none.",
            err=True,
        )
