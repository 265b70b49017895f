"""``grader check`` and ``report``: grades one submission, and writes its result in another format."""

from __future__ import annotations

import json
import shlex
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from grader.cli import confinement, exits, loading, options
from grader.submitted_files import SubmissionRefused
from kit.cli.existing_path import ExistingPath
from kit.cli.output_file import OutputFile
from kit.kernels.compilation_progress import PROGRESS
from kit.results.grading_result import GradingResult
from kit.workspace import write_atomically

if TYPE_CHECKING:
    from grader.evidence.contract import Evidence, WatchableEvidence
    from grader.grading import Grading
    from kit.results.grading_result import GradingResult

EXIT_CODES = {"pass": 0, "fail": exits.EXIT_FAILED, "broken": exits.EXIT_BROKEN}


_format_option = click.option(
    "--format",
    "format_name",
    default="text",
    show_default=True,
    metavar="NAME",
    help="text, json, junit, gradescope, classroom50, classroom, annotations, prairielearn, check50 or markdown.",
)


@click.command()
@click.argument("file", type=ExistingPath(path_type=Path))
@options.assignment
@options.level
@options.secret
@click.option(
    "--hints", type=click.IntRange(0, 3), default=1, show_default=True, help="Number of hint steps to show."
)
@_format_option
@click.option("--json", "as_json", is_flag=True, help="Same as --format json.")
@click.option("--output", type=OutputFile(), help="Write the report to this file.")
@click.option(
    "--replay",
    type=OutputFile(),
    help="Save the worst episode to this file, for `kit replay`; the first one if all pass.",
)
@click.option("--for-student", is_flag=True, help="Leave out what students may not see yet.")
@click.option("--progress-descriptor", type=click.IntRange(0), hidden=True)
def check(
    file: Path,
    folder: Path,
    level: str | None,
    secret: bool,
    hints: int,
    format_name: str,
    as_json: bool,
    output: Path | None,
    replay: Path | None,
    for_student: bool,
    progress_descriptor: int | None,
) -> None:
    """Grade FILE (or a folder or archive that contains it) for ASSIGNMENT.

    \b
    grader check my_controller.py --assignment assignments/reach

    FILE may be anybody's, so its programs run confined: at the assignment's level, at least 1; with --secret at the highest
    of this machine. A machine that cannot do that refuses. Your own program may run without: --level 0.

    Exit code: 0 passed; 1 not passed; 2 an argument is wrong or something is missing; 3 the grader failed, no grade.
    """
    from grader.cli.progress import shown_progress
    from grader.grading import GradingOptions, open_grading
    from grader.grading_level import LevelTooLow
    from grader.reports import FORMATS
    from grader.submission import read_submission

    format_name = "json" if as_json else format_name
    if format_name not in FORMATS:
        exits.fail(f"There is no format {format_name}; use one of: {', '.join(FORMATS)}.")
    with (
        shown_progress(progress_descriptor) as show_progress,
        PROGRESS.told_by(show_progress),
        _own_starts(file, level, for_student=for_student),
    ):
        show_progress("reading the exercise")
        assignment = loading.load_assignment(folder)
        loading.warn_of_unused_secrets(assignment, secret=secret)
        grading_level = confinement.level_for_untrusted(assignment, level, secret=secret)
        try:
            submission = read_submission(file, assignment.submit)
            if submission.note:
                exits.warn(f"Note: {submission.note}")
            is_for_student = for_student or FORMATS[format_name].is_for_students
            grading_options = GradingOptions(
                grading_level, secret, secret and is_for_student, show_progress=show_progress
            )
            with open_grading(assignment, submission, grading_options) as grading:
                result = grading.result()
                picture = _worst_picture(grading, replay)
                if not picture and replay is not None:
                    picture = _keep_passed_run(grading, replay)
        except (SubmissionRefused, LevelTooLow) as error:
            exits.fail(str(error))
    if for_student:
        result = result.for_student()
    text = _report(result, format_name, hints, picture)
    if output is None:
        click.echo(text, nl=False)
    else:
        write_atomically(output.absolute(), text.encode())
    # Whoever reads a report without what is shown later reads the exit code too.
    shown = result.for_student() if is_for_student else result
    raise SystemExit(EXIT_CODES[shown.verdict.value])


def _own_starts(file: Path, level: str | None, *, for_student: bool) -> AbstractContextManager[None]:
    """Has one's own program be started faster: what others' programs get is started anew each time."""
    is_own_program = for_student and level == "0" and file.suffix == ".py"
    if not is_own_program:
        return nullcontext()
    from kit.host.warm_start import warm_starts

    return warm_starts()


def _report(result: GradingResult, format_name: str, hints: int, picture: str) -> str:
    from grader.reports import FORMATS

    if format_name != "text":
        return FORMATS[format_name].write(result)
    from grader.reports.formats.text_report import write_text

    return write_text(result, hints=hints) + picture


def _worst_picture(grading: Grading, replay: Path | None) -> str:
    """Draws the worst episode, and saves it in ``replay`` if given."""
    worst = grading.scores.worst()
    shown = "" if worst is None else worst.picture()
    if worst is None or not shown:
        return ""
    watchable = _watchable(worst)
    if watchable is None:
        return f"\nPicture of {worst.label} ({worst.outcome}):\n{shown}\n"
    watch = (
        "To watch it: add --replay worst.npz" if replay is None else _save_replay(watchable, replay, grading)
    )
    return f"\n{watchable.replay_title()}:\n{shown}\n{watch}\n"


def _keep_passed_run(grading: Grading, replay: Path) -> str:
    """Saves an episode of a work that lost nothing, where its kind has any."""
    went_wrong = grading.scores.worst() is not None
    run = None if went_wrong else _watchable(grading.scores.first_public())
    if run is None:
        why = "There is no episode" if went_wrong else "No episode went wrong, and there is none"
        return f"\n{why} to save as a replay.\n"
    return f"\n{_save_replay(run, replay, grading)}\n"


def _watchable(evidence: Evidence | None) -> WatchableEvidence | None:
    from grader.evidence.contract import WatchableEvidence

    return evidence if isinstance(evidence, WatchableEvidence) and evidence.replay_title() else None


def _save_replay(run: WatchableEvidence, replay: Path, grading: Grading) -> str:
    """Saves an episode; returns how to watch it."""
    try:
        is_own_place = run.save_replay(replay.absolute())
    except OSError as error:
        exits.fail(f"Cannot write {replay}: {error.strerror or error}.")
    root = f" --root {shlex.quote(str(grading.assignment.folder))}" if is_own_place else ""
    return f"To watch it: kit replay {shlex.quote(str(replay))}{root}"


@click.command()
@click.argument("file", type=ExistingPath(dir_okay=False, path_type=Path))
@_format_option
@click.option("--output", type=OutputFile(), help="Write the report to this file.")
@click.option("--for-student", is_flag=True, help="Leave out what students may not see yet.")
@click.option(
    "--work", default="", help="For annotations: the graded file or folder, relative to the repository."
)
def report(file: Path, format_name: str, output: Path | None, for_student: bool, work: str) -> None:
    """Convert a result of `grader check --json` to another format."""
    from grader.reports import FORMATS
    from grader.reports.formats.annotations import write_annotations

    if format_name not in FORMATS:
        exits.fail(f"There is no format {format_name}; use one of: {', '.join(FORMATS)}.")
    if work and format_name != "annotations":
        exits.fail("--work is for annotations.")
    try:
        result = GradingResult.from_dict(json.loads(file.read_bytes()))
    except (KeyError, TypeError, ValueError, RecursionError):
        exits.fail(f"{file}: not a result of the grader.")
    if for_student:
        result = result.for_student()
    text = write_annotations(result, work) if work else FORMATS[format_name].write(result)
    if output is None:
        click.echo(text, nl=False)
    else:
        write_atomically(output.absolute(), text.encode())
