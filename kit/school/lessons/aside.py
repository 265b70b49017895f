"""Commands of the kit and editors, run in this terminal as a student would type them."""

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
from typing import BinaryIO, Final

from rich.text import Text

from kit.host.python_command import python_command
from kit.school.lessons.shell_lines import expand_words

NOTHING_PRINTED: Final = b"It ended and printed nothing."
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


def has_easy_editor(environment: Mapping[str, str]) -> bool:
    """Whether an editor is named, or one is here that shows its own keys."""
    return bool(environment.get("VISUAL") or environment.get("EDITOR") or shutil.which(EDITORS[0]))


def keys_of_vi(environment: Mapping[str, str], arguments: Sequence[str]) -> str:
    """Says how to write in vi and how to leave it, where it opens unasked; else empty."""
    if has_easy_editor(environment) or Path(arguments[0]).name not in EDITORS[1:]:
        return ""
    return (
        f"No editor is named in $EDITOR, and {EDITORS[0]} is not here: {Path(arguments[0]).name} opens. i begins typing, "
        "Esc ends it; then :wq and Enter save and leave, :q! and Enter leave without saving."
    )


def run_here(
    line: str, arguments: Sequence[str], environment: dict[str, str], folder: Path | None, waits: bool
) -> bytes:
    """The terminal is as a shell would have it. Ctrl-C is for the command, not for us. ``waits``: whether what it prints is to
    be read; then that is returned, unless the command had a screen of its own."""
    out = sys.__stderr__
    before = signal.signal(signal.SIGINT, _ignore)
    try:
        if out is not None:
            out.write(f"\n$ {line}\n")
            out.flush()
        if not waits or out is None:
            subprocess.run(arguments, env=environment, cwd=folder, check=False)
            return b""
        size = os.get_terminal_size(out.fileno())
        with os.fdopen(out.fileno(), "wb", buffering=0, closefd=False) as raw:
            printed = run_and_copy(arguments, environment, folder, size, raw)
        if OPENS_SCREEN in printed:  # such as a training's: what was on it is nothing to read afterwards
            return b""
        return printed or NOTHING_PRINTED
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
            while part := _read_available(ours):
                printed += part
                out.write(part)
            process.wait()
    finally:
        os.close(ours)
    return bytes(printed)


def plain_lines(printed: str) -> list[str]:
    """Returns what a terminal shows of a program's output in the end, line by line, without its colours."""
    return Text.from_ansi(printed.replace("\r\n", "\n")).plain.splitlines()


def _read_available(descriptor: int) -> bytes:
    """The next characters; none at the end, which a terminal whose other side is closed tells as an error."""
    try:
        return os.read(descriptor, 1 << 14)
    except OSError:
        return b""


def _ignore(number: int, frame: object) -> None:
    """A handler, so that the command itself starts with the usual one."""
