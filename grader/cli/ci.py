"""``grader ci``: a workflow that grades every push."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import click

from grader.assignment import Assignment
from grader.ci import SERVICES
from grader.ci.ci_service import CiRunner, GitSource, GradedWork
from grader.ci.warnings import warnings
from grader.cli import exits, loading
from kit.workspace import write_atomically

PLAIN_PATH: Final = re.compile(r"[A-Za-z0-9_./-]+")


@click.command()
@click.argument("service", type=click.Choice([*SERVICES]))
@click.option(
    "--assignment",
    "folders",
    multiple=True,
    required=True,
    metavar="FOLDER[=WORK]",
    help="Assignment folder; repeat for more. WORK: where the student's work lies, if not at the repository's top.",
)
@click.option(
    "--kit",
    required=True,
    metavar="ADDRESS[@VERSION]",
    help="Repository to clone the kit from: https://..., optionally with a branch or tag.",
)
@click.option("--python", default=CiRunner().python, show_default=True, help="Version of Python.")
@click.option("--runner", default=CiRunner().image, show_default=True, help="GitHub's runner.")
@click.option(
    "--write",
    is_flag=True,
    help="Write the file to its place below the current folder instead of printing it; always so for an archive.",
)
def ci(service: str, folders: tuple[str, ...], kit: str, python: str, runner: str, write: bool) -> None:
    """Print a workflow that grades every push: for GitHub Actions, GitLab CI or Classroom 50; or make Gradescope's
    autograder.zip.

    Give the assignments' folders relative to the repository, and the address of the kit's source:

    \b
    grader ci github --assignment tasks/one --kit https://HOST/PATH@v1
    grader ci github --assignment a=a.py --assignment b=b --kit https://HOST/PATH
    grader ci gradescope --assignment tasks/one --kit https://HOST/PATH@v1

    Anyone who can push can change the workflow and the assignment in a repository, so these results are only for practice.
    For the grade, run `grader cohort` on the submissions.
    """
    chosen = SERVICES[service]
    works, assignments = zip(*map(_graded_work, folders), strict=True)
    if len(works) > 1 and not chosen.is_in_students_repository:
        exits.fail(f"{service} takes one assignment.")
    if len({each.work for each in works}) < len(works):
        exits.fail("Two assignments have one work: say where each lies, such as tasks/one=one/controller.py.")
    if not PLAIN_PATH.fullmatch(python) or not PLAIN_PATH.fullmatch(runner):
        exits.fail("Give Python's version and the runner in letters, digits, _ . - and /.")
    try:
        source = GitSource.read(kit)
        for assignment in assignments:
            for warning in warnings(assignment, chosen):
                click.echo(warning, err=True)
        data = chosen.write(works, source, CiRunner(python, runner))
    except (ValueError, OSError) as error:
        exits.fail(f"{error}.")
    if not write and chosen.is_text:
        click.echo(data.decode(), nl=False)
        return
    file = Path(chosen.place)
    if file.exists():
        exits.fail(f"{file} already exists; remove it first. One workflow takes several --assignment.")
    file.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(file.absolute(), data)
    click.echo(f"{file}: written")


def _graded_work(text: str) -> tuple[GradedWork, Assignment]:
    """Reads ``FOLDER[=WORK]``; ends with what is wrong with it."""
    name, _, work = text.partition("=")
    folder = Path(name)
    for each in filter(None, (name, work)):
        if not PLAIN_PATH.fullmatch(each) or Path(each).is_absolute() or ".." in Path(each).parts:
            exits.fail(f"{each}: give it relative to the repository, in letters, digits, _ . - and /.")
    if not folder.is_dir():
        exits.fail(f"{name}: there is no such folder.")
    assignment = loading.load_assignment(folder)
    known = "-".join(folder.parts) or "assignment"
    return GradedWork(known, work or assignment.submit, folder.as_posix()), assignment
