"""``grader cohort`` and ``work``: many submissions, on this machine or several."""

from __future__ import annotations

import os
from pathlib import Path

import click

from grader.cli import confinement, exits, loading, options
from grader.cli.progress import counted_progress
from grader.cohort.class_findings import (
    attention_blocks,
    class_blocks,
    passed_over_line,
    unjudged_line,
)
from grader.cohort.gradebook import UNREADABLE, WAITING, as_csv, as_json, gradebook_rows, summary
from grader.cohort.queue import (
    Queue,
    QueueError,
    judge_anew,
    prepare_queue,
)
from grader.grading import GradingOptions
from kit.cli.executor_options import executor_options
from kit.cli.existing_path import ExistingPath
from kit.cli.messages import describe_error
from kit.cli.process import INTERRUPTED
from kit.document.layout import lines_of
from kit.host.job_executors import ExecutorUnavailable, read_shard
from kit.host.job_folder import JobExecutor, serve_keys
from kit.plain_text import counted
from kit.workspace import write_atomically
from kit.world.problems import WorldError


@click.command()
@click.argument("submissions", type=ExistingPath(file_okay=False, path_type=Path))
@options.assignment
@options.level
@options.secret
@click.option(
    "--examples",
    is_flag=True,
    help="With --secret: look for public runs that show students what only secret seeds show. Takes longer.",
)
@click.option(
    "--queue",
    "queue_folder",
    type=click.Path(file_okay=False, path_type=Path),
    required=True,
    help="Folder for jobs, results and the gradebook; use the same one to continue.",
)
@executor_options("Processes", "Where jobs run; none only prepares the queue, for shards.")
def cohort(
    submissions: Path,
    folder: Path,
    level: str | None,
    secret: bool,
    examples: bool,
    queue_folder: Path,
    executor: JobExecutor,
) -> None:
    """Grade every file, folder or archive in SUBMISSIONS that has no grade yet.

    \b
    grader cohort handed_in --assignment tasks/one --queue grades --secret
    grader gradebook grades

    Programs run at the highest confinement level of this machine; --level 1 takes less time. You can interrupt it; run the same command to continue. At the end it lists the submissions that need your
    attention.

    Exit code: 0 all submissions have a grade, or wait for shards; 1 some cannot be read; 2 an argument is wrong; 3 the
    grader failed for some, or a worker left no result for some; 130 interrupted by Ctrl-C.
    """
    assignment = loading.load_assignment(folder)
    if secret:
        loading.warn_of_short_seeds(assignment)
    queue = Queue(queue_folder.absolute())
    wanted = confinement.level_for_untrusted(
        assignment, level, secret=secret, for_class=True, runs_here=executor.name == "local"
    )
    grading_options = GradingOptions(wanted, secret, secret and examples, may_lower_level=False)
    if secret and wanted < assignment.level:
        exits.fail(f"Secret seeds are used at level {int(assignment.level)} or higher, not at {int(wanted)}.")
    loading.warn_of_unused_secrets(assignment, secret=secret)
    try:
        entries = prepare_queue(queue, submissions, assignment, grading_options)
        judged = judge_anew(queue)
        waiting = queue.waiting()
        anew = f", {judged} judged anew by what was found before" if judged else ""
        click.echo(f"{counted(len(entries), 'submission')}{anew}, {len(waiting)} to grade", err=True)
        with counted_progress(len(waiting), "graded") as count_one:
            executor.run(queue, waiting, lambda key: count_one())
    except KeyboardInterrupt:
        click.echo("\nWhat is graded is kept; run the same command to continue.", err=True)
        raise SystemExit(INTERRUPTED) from None
    except (QueueError, ExecutorUnavailable, OSError) as error:
        exits.fail(describe_error(error))
    raise SystemExit(publish(queue, is_graded=executor.name != "none"))


def publish(queue: Queue, *, is_graded: bool) -> int:
    """Writes the gradebook into the queue folder, lists who has no grade, and returns the exit code. ``is_graded``: every job
    should have a result by now."""
    table = gradebook_rows(queue)
    write_atomically(queue.folder / "gradebook.csv", as_csv(table).encode())
    write_atomically(queue.folder / "gradebook.json", as_json(table).encode())
    click.echo(f"{summary(table)}: {queue.folder / 'gradebook.csv'}")
    assignment = queue.assignment()
    if assignment.has_secrets and not queue.grading_options().secret:
        unjudged = unjudged_line(table, assignment.max_points)
        click.echo(" ".join(filter(None, ("Graded without --secret.", unjudged))))
    if attention := [*attention_blocks(table), *class_blocks(table)]:
        click.echo("\n".join(lines_of(attention)))
    if told := passed_over_line(queue.manifest().passed_over, "graded"):
        click.echo(
            f"{told} If one is a student's work, give it a name of its own without a dot at the beginning."
        )
    verdicts = {row.verdict for row in table}
    if is_graded and WAITING in verdicts:
        click.echo(
            "A worker left no result for some, one that cannot be read, or another job's: run the same command to grade them."
        )
        return exits.EXIT_BROKEN
    if "broken" in verdicts:
        return exits.EXIT_BROKEN
    return exits.EXIT_FAILED if UNREADABLE in verdicts else 0


@click.command()
@click.argument("folder", type=ExistingPath(file_okay=False, path_type=Path))
@click.option(
    "--shard",
    default="0/1",
    show_default=True,
    metavar="I/N",
    help="Grade the I-th of N equal parts of the works, from 0: for a CI matrix or an array job.",
)
@click.option(
    "--jobs", type=click.IntRange(1), default=os.cpu_count() or 1, show_default=True, help="Processes."
)
def work(folder: Path, shard: str, jobs: int) -> None:
    """Grade the jobs in the queue FOLDER that have no result yet.

    Exit code: 0 all have a result; 2 an argument is wrong; 3 some have none.
    """
    share = read_shard(shard)
    if share is None:
        exits.fail(f"{shard}: give the share and the number of shares, counting from 0, such as 0/4.")
    queue = Queue(folder.absolute())
    try:
        manifest = queue.manifest()
        confinement.level_for_untrusted(queue.assignment(), str(manifest.level), secret=manifest.secret)
        keys = queue.waiting(share)
        JobExecutor(jobs=jobs).run(queue, keys, lambda key: None)
    except (QueueError, WorldError, OSError) as error:
        exits.fail(describe_error(error))
    left = sum(map(queue.is_waiting, keys))
    click.echo(f"{len(keys) - left} graded" + (f", {left} without a result" if left else ""))
    if left:
        raise SystemExit(exits.EXIT_BROKEN)


@click.command(hidden=True)
@click.argument("folder", type=ExistingPath(file_okay=False, path_type=Path))
def worker(folder: Path) -> None:
    """Grade the jobs whose keys come on standard input."""
    try:
        serve_keys(Queue(folder).run_job)
    except (QueueError, WorldError) as error:
        exits.fail(describe_error(error))
