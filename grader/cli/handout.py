"""``grader release`` and ``help``: what students get of an assignment, and what its sheet may say."""

from __future__ import annotations

import inspect
import io
import shlex
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final

import click

from grader.budgets import budget_lines
from grader.ci import REPOSITORY_SERVICES, SERVICES
from grader.ci.ci_service import CiRunner, GitSource, GradedWork
from grader.cli import exits, loading
from grader.evidence_digest import ASSIGNMENT_FILE
from grader.kinds.contract import kind_names
from grader.new_assignment import CARD
from grader.reading import read_assignment
from grader.sheet_reference import SheetKey, documented_attributes, sheet_keys
from grader.student_version import ReleaseRefused, StudentVersion, missing_for_practice, student_version
from grader.teacher_tests import reading as teacher_tests
from kit.cli.existing_path import ExistingPath
from kit.document.blocks import Block, Code, Table, Text, labelled_table
from kit.document.layout import lines_of
from kit.plain_text import counted, join_names
from kit.workspace import draft_folder, write_atomically
from kit.world.problems import WorldError

ASSIGNMENT_FOLDER: Final = "assignment"
WORK_FOLDER: Final = "work"
"""Folders of a repository: what is asked, and what the student writes."""
STARTER: Final = "starter"


@click.command()
@click.argument("folder", type=ExistingPath(file_okay=False, path_type=Path))
@click.option(
    "--output",
    "target",
    type=click.Path(path_type=Path),
    required=True,
    help="Where to write it: a new folder, or a file NAME.zip.",
)
@click.option(
    "--repository",
    is_flag=True,
    help="As a repository: the assignment, a folder for the student's work, and a workflow that grades every push.",
)
@click.option(
    "--service",
    type=click.Choice(REPOSITORY_SERVICES),
    default="github",
    show_default=True,
    help="With --repository: where it will lie.",
)
@click.option(
    "--kit",
    metavar="ADDRESS[@VERSION]",
    help="With --repository: where the workflow clones the kit from: https://..., optionally with a branch or tag.",
)
@click.option("--with-reference", is_flag=True, help="Also hand out what the checks compare with.")
def release(
    folder: Path, target: Path, repository: bool, service: str, kit: str | None, with_reference: bool
) -> None:
    """Make the student's version of the assignment in FOLDER: sheet, starter, public seeds, README, and its other files.

    \b
    grader release hall --output hall-for-students
    grader release hall --output hall.zip
    grader release hall --output repo --repository --kit https://HOST/PATH@v1

    The secret seeds, solution, wrong solutions and reference stay, and so do criteria that students may not see yet. It is
    refused where a secret would go out all the same: in another file, in an archive, as a passage of the solution.

    Exit code: 0 written; 2 refused, or an argument is wrong.
    """
    assignment = loading.load_assignment(folder)
    if repository and kit is None:
        exits.fail("--repository needs --kit ADDRESS: where the workflow clones the kit from.")
    if target.exists() and (target.is_file() or any(target.iterdir())):
        exits.fail(f"{target} already exists; choose another name.")
    try:
        version = student_version(assignment, with_reference=with_reference)
        files = version.files
        if repository:
            source = GitSource.read(kit or "")
            work = GradedWork(ASSIGNMENT_FOLDER, WORK_FOLDER, ASSIGNMENT_FOLDER)
            workflow = SERVICES[service].write([work], source, CiRunner())
            files = repository_files(version, str(SERVICES[service].place), workflow, assignment.submit)
    except ReleaseRefused as refused:
        exits.fail(f"Not released.\n{refused}")
    except (ValueError, OSError) as error:
        exits.fail(f"{error}.")
    try:
        _write_handout(files, target)
    except OSError as error:
        exits.fail(f"Cannot write {target}: {error.strerror or error}.")
    click.echo(f"{target}: {counted(len(files), 'file')} for students")
    if version.kept_back:
        click.echo(f"With you stay: {join_names(version.kept_back, 8)}.")
    if version.hidden_criteria:
        click.echo(f"Left out, since students may not see it yet: {join_names(version.hidden_criteria, 8)}.")
    if missing := missing_for_practice(version):
        click.echo(missing)
    elif target.is_dir() and not repository:
        _check_readable(target)
    if repository:
        shown = shlex.quote(str(target))
        click.echo(
            f"Next: cd {shown} && git init && git add . && git commit -m 'The assignment', and push it."
        )


def repository_files(
    version: StudentVersion, workflow_path: str, workflow: bytes, submit: str
) -> Mapping[str, bytes]:
    """Returns the files of a student's repository: the assignment, their work, which begins as the starter, and the workflow."""
    files = {f"{ASSIGNMENT_FOLDER}/{name}": data for name, data in version.files.items()}
    for name, data in version.files.items():
        first, _, rest = name.partition("/")
        if rest and first == STARTER:
            files[f"{WORK_FOLDER}/{rest}"] = data
        elif not rest and first == STARTER + Path(submit).suffix:
            files[f"{WORK_FOLDER}/{submit}"] = data
    card = version.files.get(CARD, b"").decode("utf-8", "replace")
    files[CARD] = (
        card.replace("--assignment .", f"--assignment {ASSIGNMENT_FOLDER}").encode()
        + (
            f"\nYour work lies in `{WORK_FOLDER}/`. Every push is graded for practice; the run's summary says how it went.\n"
        ).encode()
    )
    files[workflow_path] = workflow
    return files


def _write_handout(files: Mapping[str, bytes], target: Path) -> None:
    """Writes the files below the folder ``target``, or into the archive of this name; a folder all or not at all."""
    if target.suffix == ".zip":
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, data in sorted(files.items()):
                entry = zipfile.ZipInfo(
                    f"{target.stem}/{name}"
                )  # without a time: equal contents give equal bytes
                entry.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(entry, data)
        write_atomically(target.absolute(), packed.getvalue())
        return
    with draft_folder(target.parent) as draft:
        for name, data in files.items():
            (draft / name).parent.mkdir(parents=True, exist_ok=True)
            (draft / name).write_bytes(data)
        draft.rename(target)  # an empty folder of that name makes room


def _check_readable(folder: Path) -> None:
    """Says what the student's version lacks, where it cannot be read any more without what stays."""
    try:
        read_assignment(folder)
    except WorldError as error:
        exits.warn(f"WARNING: students cannot check their work with it: {error}")


@click.command()
@click.argument("topic", type=click.Choice(["sheet", "tests"]))
@click.argument("kind", type=click.Choice(kind_names()), default="controller")
def help_page(topic: str, kind: str) -> None:
    """Explain every key of an assignment's sheet, for a KIND of submission: type, default, and an example. Or how to write
    tests of your own, and what they can examine.

    \b
    grader help sheet
    grader help sheet reward
    grader help tests
    """
    click.echo("\n".join(lines_of(sheet_blocks(kind) if topic == "sheet" else tests_blocks())))


def tests_blocks() -> list[Block]:
    """Returns the page on a teacher's own tests."""
    # Only for this page: they bring numpy.
    from grader.driving.drive_record import GradedDrive, TopicTraffic
    from kit.run.metrics import DriveMetrics

    told = (inspect.getdoc(teacher_tests) or "").split("\n\n")
    code = next(part for part in told if part.startswith("    "))
    texts = [
        " ".join(part.split()).replace("``", "`").replace("::", ":") for part in told if part is not code
    ]
    return [
        *(Text(text) for text in texts[:2]),
        Code(tuple(inspect.cleandoc(code).splitlines())),
        *(Text(text) for text in texts[2:]),
        Text(
            "Of a controller, `grading.evidence(ID)` gives the drives that the criterion with this id is judged on, each "
            "with what follows. Of another kind it gives what its checks measure: their source says what that is."
        ),
        labelled_table(documented_attributes(GradedDrive), "A drive:"),
        labelled_table(documented_attributes(DriveMetrics), "drive.score:"),
        labelled_table(documented_attributes(TopicTraffic), "drive.traffic[TOPIC]:"),
    ]


def sheet_blocks(kind: str) -> list[Block]:
    """Returns the page on the sheet of a kind."""
    keys = sheet_keys(kind)
    public = [key for key in keys if not key.path.startswith("secret.")]
    secret = [key for key in keys if key.path.startswith("secret.")]
    others = ", ".join(each for each in kind_names() if each != kind)
    return [
        Text(
            f"{ASSIGNMENT_FILE} of the kind {kind}. A key that begins like another stands inside it: checks.points is the key "
            "points of an entry of checks."
        ),
        _key_table("", public),
        *([_key_table("secret.yaml, for the teacher's machine alone:", secret)] if secret else []),
        labelled_table(budget_lines(), "Under budget:"),
        Text(f"Other kinds: {others}."),
    ]


def _key_table(title: str, keys: Iterable[SheetKey]) -> Table:
    return labelled_table(((key.path.removeprefix("secret."), _describe_key(key)) for key in keys), title)


def _describe_key(key: SheetKey) -> str:
    """What a key means, what it holds, and what it is without being given."""
    default = key.key.default
    if "by default" in key.meaning:
        told = ""
    elif default is None:
        told = "; must be given"
    else:
        told = "; optional" if default in ("none", '""', "{}", "[]") else f"; by default {default}"
    example = f"; such as {key.example}" if key.example and key.example != default else ""
    return f"{key.meaning.removeprefix('In secret.yaml: ')}. ({key.key.type}{told}{example})"
