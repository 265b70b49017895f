"""What a verb says to a person: sentences that fit the terminal, and errors that end it with exit code 2."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import NoReturn

import click

from kit.cli.process import BAD_INPUT, NO_ROOM, describe_no_room
from kit.plain_files import nearest_file
from kit.plain_text import escape_controls, wrap

SENTENCE_WIDTH = 78
"""Columns of sentences that are printed."""


def fail(message: str) -> NoReturn:
    """Prints ``message`` on standard error and ends the verb with exit code 2."""
    click.echo(on_terminal(escape_controls(message)), err=True)
    raise SystemExit(BAD_INPUT)


def say(text: str, *, err: bool = False) -> None:
    """Prints sentences, in lines that fit a terminal of 80 columns."""
    click.echo("\n".join(line for part in text.splitlines() for line in wrap(part, SENTENCE_WIDTH)), err=err)


def on_terminal(message: str) -> str:
    """The lines of an error's message, broken between words where a terminal shows them; a log keeps each whole."""
    if not sys.stderr.isatty():
        return message
    columns = min(shutil.get_terminal_size().columns, SENTENCE_WIDTH + 2)
    return "\n".join(
        part
        for line in message.splitlines()
        for part in (
            wrap(line, columns, _indent_of(line), _indent_of(line)) if len(line) > columns else [line]
        )
    )


def _indent_of(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]


def describe_os_error(error: OSError) -> str:
    """Formats an error with its file, and the way out where there is no room. Raises one without a file again, as of what is
    printed: the process says it, in the same words for every command."""
    if error.errno in NO_ROOM and error.filename is None:
        raise error
    if error.errno in NO_ROOM:
        return describe_no_room(error)
    if not error.filename or not error.strerror:
        return str(error)
    near = nearest_file(Path(error.filename)) if isinstance(error, FileNotFoundError) else ""
    return f"{error.filename}: {error.strerror}" + (f". Did you mean {near}?" if near else "")


def describe_error(error: Exception) -> str:
    """What an error says, with the file where it is one of the system. Raises as ``describe_os_error`` does."""
    return describe_os_error(error) if isinstance(error, OSError) else str(error)


def replace_unencodable(text: str) -> str:
    """Replaces each character that standard output cannot encode by a question mark."""
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    return text.encode(encoding, errors="replace").decode(encoding)
