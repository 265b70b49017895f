"""Options that several verbs share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NoReturn

import click

from kit.cli.existing_path import ExistingPath
from kit.cli.messages import on_terminal

if TYPE_CHECKING:
    from grader.assignment import Assignment
    from kit.host.sandbox.sandbox_config import Level

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

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


assignment: Decorator = click.option(
    "--assignment",
    "folder",
    type=ExistingPath(file_okay=False, path_type=Path),
    required=True,
    help="Assignment folder.",
)
level: Decorator = click.option(
    "--level",
    type=click.Choice(["0", "1", "2", "3", "highest"]),
    help="Confinement level of programs, exactly that; highest: the highest of this machine.",
)
secret: Decorator = click.option(
    "--secret",
    is_flag=True,
    help="Also use secret.yaml, its seeds or answers: for the grade, on the teacher's machine.",
)


def load_assignment(folder: Path) -> Assignment:
    """Reads the assignment; ends with its mistakes and exit code 2 if it has any."""
    from grader.reading import read_assignment
    from kit.world.problems import WorldError

    try:
        return read_assignment(folder)
    except WorldError as error:
        fail(str(error))


NO_SECRETS_WARNING: Final = (
    "WARNING: this assignment has a secret.yaml, but --secret was not given. This is not the final grade: what only the "
    "secret file can show is not graded and costs no points. For the grade, run it again with --secret."
)


def warn_of_unused_secrets(assignment: Assignment, *, secret: bool) -> None:
    """Prints a warning on standard error where there is a secret file that is not used."""
    if assignment.has_secrets and not secret:
        click.echo(NO_SECRETS_WARNING, err=True)


def warn_of_short_seeds(assignment: Assignment) -> None:
    """Prints a warning on standard error where secret seeds can be guessed."""
    from grader.seeds import short_seeds_warning

    warning = short_seeds_warning(assignment.secret_seeds)
    if warning:
        click.echo(warning, err=True)


def level_for_untrusted(
    assignment: Assignment, text: str | None, *, secret: bool, for_class: bool = False, runs_here: bool = True
) -> Level:
    """The confinement level at which programs of others are graded; exit code 2 if they run here and this machine does
    not reach it.

    ``text``: the option ``--level``. Without it, the level is the highest of this machine where secrets are used or a class
    is graded, and else the assignment's; at least 1 in any case.
    """
    from grader import grading
    from kit.host.sandbox.probe import highest_level_up_to
    from kit.host.sandbox.sandbox_config import Level

    level = grading.level_for_untrusted(assignment, to_level(text))
    if text is None and (secret or for_class):
        level = max(level, highest_level_up_to(Level.ANOTHER_USER))
    if not runs_here or highest_level_up_to(level) == level:
        return level
    fail(grading.level_unavailable_text(assignment, level, secret=secret))


def to_level(text: str | None) -> Level | None:
    """Returns the level that was asked for; None where none was. ``highest``: of this machine, but never below 1."""
    from kit.host.sandbox.probe import highest_level_up_to
    from kit.host.sandbox.sandbox_config import Level

    if text == "highest":
        return max(Level.FILTERED, highest_level_up_to(Level.ANOTHER_USER))
    return None if text is None else Level(int(text))
