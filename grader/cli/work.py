"""``grader work``: a share of a queue, on this machine."""

from __future__ import annotations

import os
import re
from pathlib import Path

import click

from grader.cli import options


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option(
    "--shard",
    default="0/1",
    show_default=True,
    metavar="I/N",
    help="Only share I of N, from 0; for a CI matrix or an array job.",
)
@click.option(
    "--jobs", type=click.IntRange(1), default=os.cpu_count() or 1, show_default=True, help="Processes."
)
def command(folder: Path, shard: str, jobs: int) -> None:
    """Work off the jobs in the queue FOLDER that have no result yet."""
    from grader.cohort.executors import run_locally
    from grader.cohort.queue import Queue, QueueError

    found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", shard)
    if found is None or not int(found[1]) < int(found[2]):
        options.fail(f"{shard}: say which share of how many, from 0, such as 0/4.")
    queue = Queue(folder.absolute())
    try:
        keys = queue.waiting((int(found[1]), int(found[2])))
        run_locally(queue, keys, jobs, lambda key: None)
    except (QueueError, OSError) as error:
        options.fail(str(error))
    click.echo(f"{len(keys)} graded")
