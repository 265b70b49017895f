"""``grader check``: one submission, judged at once."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from grader.verbs import options

if TYPE_CHECKING:
    from grader.grading import Grading
    from grader.result import Result

EXITS = {"pass": 0, "fail": options.FAILED, "broken": options.BROKEN}


@click.command()
@click.argument("file", type=click.Path(exists=True, path_type=Path))
@options.assignment
@options.level
@click.option(
    "--require-level",
    type=click.IntRange(0, 3),
    help="Refuse to grade where the machine cannot lock in so far.",
)
@options.secret
@click.option(
    "--hints", type=click.IntRange(0, 3), default=1, show_default=True, help="How many hint steps to show."
)
@click.option(
    "--format",
    "form",
    default="text",
    show_default=True,
    metavar="NAME",
    help="text, json, junit, gradescope, classroom, prairielearn, check50 or markdown.",
)
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
@click.option(
    "--output", type=click.Path(dir_okay=False, path_type=Path), help="Write the report there instead."
)
@click.option(
    "--replay",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Keep the worst episode there, for `kit replay`.",
)
@click.option("--for-student", is_flag=True, help="Leave out what is hidden from students for now.")
def command(
    file: Path,
    folder: Path,
    level: int | None,
    require_level: int | None,
    secret: bool,
    hints: int,
    form: str,
    as_json: bool,
    output: Path | None,
    replay: Path | None,
    for_student: bool,
) -> None:
    """Run FILE (or a folder or archive that holds it) as ASSIGNMENT asks, and say what it earns.

    \b
    grader check my_controller.py --assignment assignments/reach

    Exit code: 0 it passes; 1 it does not; 2 something named is wrong or missing; 3 the grader is broken, no grade.
    """
    from grader.archives import Refused
    from grader.session import LevelTooLow, Terms, opened
    from grader.submission import take
    from grader.writers import FORMATS

    form = "json" if as_json else form
    if form not in FORMATS:
        options.fail(f"There is no format {form}; there are: {', '.join(FORMATS)}.")
    assignment = options.read_assignment(folder)
    wanted = options.as_level(level if level is not None else require_level)
    try:
        submission = take(file, assignment.submit)
        with opened(assignment, submission, Terms(wanted, secret)) as grading:
            result = grading.result()
            picture = _worst(grading, replay)
    except (Refused, LevelTooLow) as error:
        options.fail(str(error))
    if for_student:
        result = result.for_student()
    text = _report(result, form, hints, picture)
    if output is None:
        click.echo(text, nl=False)
    else:
        from kit.workspace import write_atomically

        write_atomically(output.absolute(), text.encode())
    raise SystemExit(EXITS[result.verdict.value])


def _report(result: Result, form: str, hints: int, picture: str) -> str:
    from grader.writers import terminal, writer

    return terminal.write(result, hints=hints) + picture if form == "text" else writer(form)(result)


def _worst(grading: Grading, replay: Path | None) -> str:
    """The worst episode in characters; and kept in a file, if asked for."""
    from grader.drive import Drive
    from grader.kinds.contract import Look
    from kit.recording import save

    worst = grading.worst()
    if worst is None:
        return ""
    shown = worst.picture()
    if not shown:
        return ""
    ways = ""
    if replay is not None and isinstance(worst, Drive):
        save(worst.recording, replay.absolute())
        ways = f"Watch it move: kit replay {replay}\n"
    title = f"The worst episode, {worst.label} ({worst.outcome})"
    if isinstance(worst, Look):
        title = f"A look at {worst.label} ({worst.outcome})"
    elif not isinstance(worst, Drive):
        title = "What a robot does that has learnt this reward perfectly"
    return f"\n{title}:\n{shown}\n{ways}"
