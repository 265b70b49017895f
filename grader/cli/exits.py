"""How a verb ends that cannot do its work: a message on standard error, and an exit code."""

from __future__ import annotations

from typing import Final, NoReturn

import click

from kit.cli.messages import on_terminal

EXIT_FAILED: Final = 1
EXIT_BAD_INPUT: Final = 2
EXIT_BROKEN: Final = 3
"""The grader itself failed, not the student's program."""


def fail(message: str, code: int = EXIT_BAD_INPUT) -> NoReturn:
    """Ends the verb with this message on standard error."""
    warn(on_terminal(message))
    raise SystemExit(code)


def warn(message: str) -> None:
    """Prints a message on standard error: it may hold a student's words, and that of a CI job is read for commands."""
    from grader.reports.cleaning import plain

    click.echo(plain(message), err=True)
