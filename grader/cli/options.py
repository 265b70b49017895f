"""Options that several verbs share."""

from __future__ import annotations

from pathlib import Path

import click

from kit.cli.existing_path import ExistingPath
from kit.cli.options import Decorator

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
