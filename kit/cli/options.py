"""Options that several verbs share, and how a user's mistake ends: one clear line and exit code 2."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

import click

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

BAD_INPUT = 2


def fail(message: str) -> NoReturn:
    """Ends the verb with this message on standard error."""
    click.echo(message, err=True)
    raise SystemExit(BAD_INPUT)


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
controller: Decorator = click.option(
    "--controller",
    default="random_walk",
    show_default=True,
    help="A controller by name, or a Python file with a ROS 2 node.",
)
case: Decorator = click.option(
    "--case", help="Which start and target of a map with several; `kit maps` lists them."
)
root: Decorator = click.option(
    "--root",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="The folder that a world file may read; by default its own.",
)
