"""``grader cohort``: a folder of submissions becomes a gradebook."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from grader.cli import options

if TYPE_CHECKING:
    from grader.cohort.queue import Queue


@click.command()
@click.argument("submissions", type=click.Path(exists=True, file_okay=False, path_type=Path))
@options.assignment
@options.level
@options.secret
@click.option(
    "--queue",
    "queue_folder",
    type=click.Path(file_okay=False, path_type=Path),
    required=True,
    help="Where jobs, results and the gradebook lie; the same folder again goes on.",
)
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=os.cpu_count() or 1,
    show_default=True,
    help="Processes; or tasks of an array job.",
)
@click.option(
    "--executor",
    type=click.Choice(["local", "slurm", "dask", "none"]),
    default="local",
    show_default=True,
    help="Who does the work; none: only prepare the queue, for shards.",
)
@click.option("--cluster", default="", metavar="ADDRESS", help="Of the Dask scheduler.")
def command(
    submissions: Path,
    folder: Path,
    level: int | None,
    secret: bool,
    queue_folder: Path,
    jobs: int,
    executor: str,
    cluster: str,
) -> None:
    """Grade every file, folder or archive in SUBMISSIONS. What was graded before is not graded again.

    Stop it at any moment and say the same again: it goes on. Exit code: 0 everything has a grade; 2 something named is
    wrong; 3 for some the grader broke.
    """
    from grader.cohort.executors import ExecutorUnavailable, run_locally, run_on_dask, run_on_slurm
    from grader.cohort.queue import Queue, QueueError, prepare_queue
    from grader.grading import GradingOptions
    from kit.host.sandbox.probe import highest

    def count(key: str) -> None:
        bar.update(1)

    assignment = options.read_assignment(folder)
    queue = Queue(queue_folder.absolute())
    terms = GradingOptions(options.as_level(level), secret, may_fall=False)
    wanted = assignment.level if terms.level is None else terms.level
    if secret and wanted < assignment.level:
        options.fail(
            f"Secret seeds are used at level {int(assignment.level)} or higher, not at {int(wanted)}."
        )
    if executor == "local" and highest() < wanted:
        options.fail(f"This machine does not reach confinement level {int(wanted)}; `kit doctor` says why.")
    try:
        entries = prepare_queue(queue, submissions, assignment, terms)
        waiting = queue.waiting()
        click.echo(f"{len(entries)} submissions, {len(waiting)} to grade", err=True)
        with click.progressbar(length=len(waiting), label="graded", file=sys.stderr) as bar:
            if executor == "slurm":
                run_on_slurm(queue, jobs)
            elif executor == "dask":
                run_on_dask(queue, waiting, cluster, count)
            elif executor == "local":
                run_locally(queue, waiting, jobs, count)
    except (QueueError, ExecutorUnavailable, OSError) as error:
        options.fail(str(error))
    raise SystemExit(publish(queue))


def publish(queue: Queue) -> int:
    """Writes the gradebook into the queue folder; the exit code."""
    from grader.cohort.gradebook import as_csv, as_json, gradebook_rows, summary
    from kit.workspace import write_atomically

    table = gradebook_rows(queue)
    write_atomically(queue.folder / "gradebook.csv", as_csv(table).encode())
    write_atomically(queue.folder / "gradebook.json", as_json(table).encode())
    click.echo(f"{summary(table)}: {queue.folder / 'gradebook.csv'}")
    return options.BROKEN if any(row.verdict == "broken" for row in table) else 0
