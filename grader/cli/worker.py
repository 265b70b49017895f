"""``grader worker``: one of the processes that a pool starts. Not for people."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click


@click.command(hidden=True)
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
def command(folder: Path) -> None:
    """Grade the jobs whose keys come on standard input."""
    from grader.cohort.queue import Queue
    from grader.cohort.work import serve_jobs

    # What anything below prints must not stand between the answers.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    serve_jobs(Queue(folder), sys.stdin, answers)
