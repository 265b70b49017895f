"""Options that several verbs share, and how a user's mistake ends: one clear line and exit code 2."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, NoReturn

import click

from kit.tui.terminal import (
    COLOUR_CHOICES,
    GLYPH_CHOICES,
    TerminalDecision,
    TerminalFacts,
    TerminalOptions,
    decide,
)
from kit.workspace import Workspace, WorkspaceError, open_workspace

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

BAD_INPUT = 2

Storage = Literal["mcap", "sqlite3"]
"""Kinds of bags."""


def fail(message: str) -> NoReturn:
    """Ends the verb with this message on standard error."""
    click.echo(message, err=True)
    raise SystemExit(BAD_INPUT)


def reason(error: OSError) -> str:
    """What could not be done with a file, in words."""
    return f"{error.filename}: {error.strerror}" if error.filename and error.strerror else str(error)


def sayable(text: str) -> str:
    """The text with a question mark for what standard output has no character for."""
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    return text.encode(encoding, errors="replace").decode(encoding)


def desk(folder: Path | None) -> Workspace:
    """The workspace, without making it; or the end of the verb."""
    try:
        return open_workspace(folder, make=False)
    except WorkspaceError as error:
        fail(str(error))


def terminal(*, plain: bool = False, glyphs: str | None = None, color: str | None = None) -> TerminalDecision:
    """What this terminal gets, decided once."""
    wish = next((choice for choice in GLYPH_CHOICES if choice == glyphs), None)
    return decide(os.environ, TerminalFacts.here(), TerminalOptions(plain, wish, color))


workspace: Decorator = click.option(
    "--workspace",
    type=click.Path(file_okay=False, path_type=Path),
    help="Where your files live; by default $KIT_WORKSPACE, else ~/robot-kit.",
)
seed: Decorator = click.option(
    "--seed",
    type=click.IntRange(0, 2**63 - 1),
    default=0,
    show_default=True,
    help="Of all noise and chance: the same seed, the same run.",
)


def controller_of(default: str) -> Decorator:
    """Who drives, unless somebody else is named."""
    return click.option(
        "--controller",
        default=default,
        show_default=True,
        help="A controller by name, or a Python file with a ROS 2 node.",
    )


controller: Decorator = controller_of("random_walk")
case: Decorator = click.option(
    "--case", help="Which start and target of a map with several; `kit maps` lists them."
)
glyphs: Decorator = click.option(
    "--glyphs", type=click.Choice(GLYPH_CHOICES), help="What the world is drawn with."
)
color: Decorator = click.option(
    "--color", type=click.Choice(COLOUR_CHOICES), help="How many colours; NO_COLOR is heeded too."
)
root: Decorator = click.option(
    "--root",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="The folder that a world file may read; by default its own.",
)
storage: Decorator = click.option(
    "-s",
    "--storage",
    type=click.Choice(["mcap", "sqlite3"]),
    default="mcap",
    show_default=True,
    help="Of bags: mcap for ROS 2 Iron and later; sqlite3 for Humble.",
)


def explain_storage(kind: Storage) -> None:
    """Says which ROS 2 reads such a bag, and which does not."""
    if kind == "mcap":
        click.echo(
            "The bag is in MCAP: ROS 2 Humble needs its MCAP plugin to read it; `-s sqlite3` writes what it reads as it is.",
            err=True,
        )
