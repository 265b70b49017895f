"""``grader ci``: workflow files."""

from __future__ import annotations

import re
from pathlib import Path

import click

from grader.ci import WORKFLOWS, GitSource, workflow
from grader.cli import options

PLAIN = re.compile(r"[A-Za-z0-9_./-]+")


@click.command()
@click.argument("service", type=click.Choice(sorted(WORKFLOWS)))
@options.assignment
@click.option(
    "--kit",
    required=True,
    metavar="ADDRESS[@VERSION]",
    help="Where the kit is cloned from: https://..., perhaps with a branch or tag.",
)
@click.option(
    "--write",
    is_flag=True,
    help="Put the file where it belongs, below the present folder, instead of printing it.",
)
def command(service: str, folder: Path, kit: str, write: bool) -> None:
    """Print a workflow that grades every push: for GitHub Actions (and GitHub Classroom) or GitLab CI.

    Say the assignment's folder as it is called in the repository, and where the kit's source is kept:

    \b
    grader ci github --assignment tasks/one --kit https://HOST/PATH@v1
    """
    from kit.workspace import write_atomically

    assignment = options.read_assignment(folder)
    name = folder.as_posix()
    if not PLAIN.fullmatch(name) or folder.is_absolute() or ".." in folder.parts:
        options.fail(f"{name}: name the folder relative to the repository, in letters, digits, _ . - and /.")
    try:
        text = workflow(service, submit=assignment.submit, assignment=name, kit=GitSource.read(kit))
    except ValueError as error:
        options.fail(f"{error}.")
    if not write:
        click.echo(text, nl=False)
        return
    file = Path(WORKFLOWS[service][0])
    if file.exists():
        options.fail(f"{file} is there already; remove it first.")
    file.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(file.absolute(), text.encode())
    click.echo(f"{file}: written")
