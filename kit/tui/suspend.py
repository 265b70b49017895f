"""Lends the terminal of a suspended full screen to a command of the kit, or to an editor."""

from __future__ import annotations

import os
import shlex
from pathlib import Path
from typing import Any

from textual.app import App, SuspendNotSupported

from kit.school.lessons.aside import EDITORS, arguments_of, editor_arguments, run_here
from kit.tui.terminal import TerminalDecision


def run_aside(
    app: App[Any],
    line: str,
    terminal: TerminalDecision,
    *,
    workspace: Path,
    folder: Path | None = None,
    waits: bool = False,
) -> str | None:
    """Runs a command in the terminal and comes back when it ends; None where that is not possible.

    ``folder``: where it runs. ``waits``: whether what it printed is to be read: then it is returned; else "".
    """
    arguments = arguments_of(line)
    if arguments is None:
        return None
    printed = b""
    settings = {**terminal.environment(), "KIT_WORKSPACE": str(workspace)}
    if terminal.glyphs.value == "ascii":
        settings["PYTHONIOENCODING"] = (
            "ascii:replace"  # for who is run: the same terminal, the same characters
        )
    try:
        with app.suspend():
            printed = run_here(line, arguments, {**os.environ, **settings}, folder, waits)
    except SuspendNotSupported:
        return None
    return printed.decode(errors="replace")


def edit_aside(app: App[Any], file: Path, line: int, terminal: TerminalDecision) -> str:
    """Opens a file in the user's editor, in this terminal, and comes back when it ends. Returns what went wrong; empty:
    nothing."""
    arguments = editor_arguments(os.environ, file, line)
    if arguments is None:
        return f"Neither $VISUAL nor $EDITOR names an editor, and {', '.join(EDITORS)} are not here. Edit {file} in a second terminal."
    try:
        with app.suspend():
            run_here(
                shlex.join(arguments), arguments, {**os.environ, **terminal.environment()}, file.parent, False
            )
    except SuspendNotSupported:
        return f"This terminal cannot be lent to an editor. Edit {file} in a second one."
    except OSError as error:
        return f"{arguments[0]} could not be started ({error.strerror}). Name another editor in $EDITOR."
    return ""
