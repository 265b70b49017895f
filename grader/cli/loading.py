"""The assignment of a verb: its mistakes end the verb, and its secrets may give a warning."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from grader.cli.exits import fail
from grader.seeds import short_seeds_warning
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from grader.assignment import Assignment

NO_SECRETS_WARNING: Final = (
    "WARNING: this assignment has a secret.yaml, but --secret was not given. This is not the final grade: what only the "
    "secret file can show is not graded and costs no points. For the grade, run it again with --secret."
)


def load_assignment(folder: Path) -> Assignment:
    """Reads the assignment; ends with its mistakes and exit code 2 if it has any."""
    from grader.reading import read_assignment

    try:
        return read_assignment(folder)
    except WorldError as error:
        fail(str(error))


def warn_of_unused_secrets(assignment: Assignment, *, secret: bool) -> None:
    """Prints a warning on standard error where there is a secret file that is not used."""
    if assignment.has_secrets and not secret:
        click.echo(NO_SECRETS_WARNING, err=True)


def warn_of_short_seeds(assignment: Assignment) -> None:
    """Prints a warning on standard error where secret seeds can be guessed."""
    warning = short_seeds_warning(assignment.secret_seeds)
    if warning:
        click.echo(warning, err=True)
