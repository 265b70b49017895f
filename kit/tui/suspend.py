"""A command of the kit, run in this terminal while the screen steps aside: it is what the student would type."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from textual.app import App, SuspendNotSupported

from kit.tui.terminal import TerminalDecision

PROGRAMS: Final = {"kit": "kit", "grader": "grader"}
"""What may be run: the first word of a command, and its Python module."""


def arguments_of(line: str) -> list[str] | None:
    """The words of a command to run; None if it is not one of the kit's."""
    try:
        words = shlex.split(line)
    except ValueError:
        return None
    if not words or words[0] not in PROGRAMS:
        return None
    return [sys.executable, "-m", PROGRAMS[words[0]], *words[1:]]


def run_aside(
    app: App[Any],
    line: str,
    terminal: TerminalDecision,
    *,
    workspace: Path,
    folder: Path | None = None,
    waits: bool = False,
) -> bool:
    """Runs a command in the terminal and comes back when it ends. ``folder``: where it runs. ``waits``: until Enter,
    so that what it printed can be read. False where that is not possible."""
    arguments = arguments_of(line)
    if arguments is None:
        return False
    settings = {**terminal.environment(), "KIT_WORKSPACE": str(workspace)}
    if terminal.glyphs.value == "ascii":
        settings["PYTHONIOENCODING"] = (
            "ascii:replace"  # for who is run: the same terminal, the same characters
        )
    try:
        with app.suspend():
            _run(line, arguments, {**os.environ, **settings}, folder, waits)
    except SuspendNotSupported:
        return False
    return True


def _run(
    line: str, arguments: Sequence[str], environment: dict[str, str], folder: Path | None, waits: bool
) -> None:
    """The terminal is as a shell would have it. Ctrl-C is for the command, not for us."""
    out = sys.__stderr__
    before = signal.signal(signal.SIGINT, _ignore)
    try:
        if out is not None:
            out.write(f"\n$ {line}\n")
            out.flush()
        subprocess.run(arguments, env=environment, cwd=folder, check=False)
        if waits and out is not None and sys.__stdin__ is not None:
            out.write("\nEnter goes back. ")
            out.flush()
            sys.__stdin__.readline()
    finally:
        signal.signal(signal.SIGINT, before)


def _ignore(number: int, frame: object) -> None:
    """A handler, so that the command itself starts with the usual one."""
