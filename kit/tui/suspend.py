"""Runs a command of the kit in this terminal while the screen is suspended, as the student would type it."""

from __future__ import annotations

import os
import pty
import shlex
import shutil
import signal
import subprocess
import sys
import termios
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO, Final

from rich.text import Text
from textual.app import App, SuspendNotSupported

from kit.host.python_command import python_command
from kit.school.lessons.shell_lines import expand_words
from kit.tui.terminal import TerminalDecision

ROWS_AROUND: Final = 5
"""Rows above and below what a command printed: the command itself, and how to go back."""
OPENS_SCREEN: Final = b"\x1b[?1049h"
"""What a program sends to a terminal before it uses the whole screen."""
PROGRAMS: Final = {"kit": "kit", "grader": "grader"}
"""What may be run: the first word of a command, and its Python module."""
EDITORS: Final = ("nano", "vim", "vi")
"""Looked for where no editor is named, the easiest first."""
TAKE_LINE: Final = frozenset((*EDITORS, "nvim", "emacs", "micro", "ne", "joe", "kak", "hx"))
"""Editors that open a file at a line given as ``+LINE`` before it."""


def arguments_of(line: str) -> list[str] | None:
    """The words of a command to run; None if it is not one of the kit's."""
    try:
        words = shlex.split(line)
    except ValueError:
        return None
    if not words or words[0] not in PROGRAMS:
        return None
    return python_command(PROGRAMS[words[0]], *expand_words(words[1:]))


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

    ``folder``: where it runs. ``waits``: until Enter, so that what it printed can be read. Where that was more than
    the terminal shows, it comes back at once and returns what was printed, to be looked at page by page; else "".
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
            printed = _run(line, arguments, {**os.environ, **settings}, folder, waits)
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
            _run(
                shlex.join(arguments), arguments, {**os.environ, **terminal.environment()}, file.parent, False
            )
    except SuspendNotSupported:
        return f"This terminal cannot be lent to an editor. Edit {file} in a second one."
    except OSError as error:
        return f"{arguments[0]} could not be started ({error.strerror}). Name another editor in $EDITOR."
    return ""


def editor_arguments(environment: Mapping[str, str], file: Path, line: int) -> list[str] | None:
    """The command that opens a file at a line in $VISUAL, $EDITOR, or the first of ``EDITORS`` that is here; None: none."""
    named = environment.get("VISUAL") or environment.get("EDITOR")
    if not named:
        found = next((each for each in EDITORS if shutil.which(each)), None)
        if found is None:
            return None
        named = found
    try:
        words = shlex.split(named)
    except ValueError:
        return None
    takes_line = Path(words[0]).name in TAKE_LINE and line > 1
    return [*words, *([f"+{line}"] if takes_line else []), str(file)]


def _run(
    line: str, arguments: Sequence[str], environment: dict[str, str], folder: Path | None, waits: bool
) -> bytes:
    """The terminal is as a shell would have it. Ctrl-C is for the command, not for us. Returns what is to be paged."""
    out = sys.__stderr__
    before = signal.signal(signal.SIGINT, _ignore)
    try:
        if out is not None:
            out.write(f"\n$ {line}\n")
            out.flush()
        if not waits or out is None or sys.__stdin__ is None:
            subprocess.run(arguments, env=environment, cwd=folder, check=False)
            return b""
        size = os.get_terminal_size(out.fileno())
        with os.fdopen(out.fileno(), "wb", buffering=0, closefd=False) as raw:
            printed = run_and_copy(arguments, environment, folder, size, raw)
        if OPENS_SCREEN in printed:  # such as a training's: what was on it is nothing to read afterwards
            return b""
        if row_count(printed, size.columns) > size.lines - ROWS_AROUND:
            return printed
        out.write("\nEnter goes back. ")
        out.flush()
        sys.__stdin__.readline()
        return b""
    finally:
        signal.signal(signal.SIGINT, before)


def run_and_copy(
    arguments: Sequence[str],
    environment: dict[str, str],
    folder: Path | None,
    size: os.terminal_size,
    out: BinaryIO,
) -> bytes:
    """Runs a command on a terminal of its own of that size, copies what it prints to ``out``, and returns it."""
    ours, theirs = pty.openpty()
    try:
        termios.tcsetwinsize(theirs, (size.lines, size.columns))
        with subprocess.Popen(
            arguments, env=environment, cwd=folder, stdout=theirs, stderr=theirs
        ) as process:
            os.close(theirs)
            printed = bytearray()
            while part := _read_part(ours):
                printed += part
                out.write(part)
            process.wait()
    finally:
        os.close(ours)
    return bytes(printed)


def row_count(printed: bytes, columns: int) -> int:
    """Rows that a text takes on a terminal of so many columns."""
    return sum(max(1, -(-len(line) // columns)) for line in plain_lines(printed.decode(errors="replace")))


def plain_lines(printed: str) -> list[str]:
    """Returns what a terminal shows of a program's output in the end, line by line, without its colours."""
    return Text.from_ansi(printed.replace("\r\n", "\n")).plain.splitlines()


def _read_part(descriptor: int) -> bytes:
    """The next characters; none at the end, which a terminal whose other side is closed tells as an error."""
    try:
        return os.read(descriptor, 1 << 14)
    except OSError:
        return b""


def _ignore(number: int, frame: object) -> None:
    """A handler, so that the command itself starts with the usual one."""
