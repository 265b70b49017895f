"""``grader new``: an assignment to start from."""

from __future__ import annotations

import shutil
from pathlib import Path

import click

from grader.cli import options

TEMPLATES = Path(__file__).parents[1] / "templates"


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--kind",
    type=click.Choice(
        sorted(each.name for each in TEMPLATES.iterdir() if each.is_dir() and each.name[0] != "_")
    ),
    default="controller",
    show_default=True,
    help="What students hand in.",
)
def command(folder: Path, kind: str) -> None:
    """Make the assignment FOLDER: a working example with starter, solution, wrong solutions and secret seeds.

    Change it step by step, and run `grader self-test FOLDER` after each.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        options.fail(f"{folder} is there already and not empty; name another folder.")
    try:
        shutil.copytree(
            TEMPLATES / kind,
            folder,
            dirs_exist_ok=True,
            ignore=shutil.ignore_patterns("__pycache__", "*.pyc"),
        )
    except OSError as error:
        options.fail(f"{folder} cannot be made: {error.strerror or error}.")
    click.echo(f"{folder}: {kind}, ready. Try it: grader self-test {folder}")
    click.echo(f"Then change {folder}/assignment.yaml. What can be checked: grader checks {kind}")
