"""Executors that work through a queue: local processes, a SLURM job array, or a Dask cluster."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from grader.cohort.queue import Queue
from grader.cohort.work import WorkerPool, grade_job, record_incident
from kit.host import job_executors
from kit.host.job_executors import ExecutorUnavailable as ExecutorUnavailable


def run_locally(queue: Queue, keys: Sequence[str], jobs: int, on_done: Callable[[str], None]) -> None:
    """Grades the jobs in processes on this machine."""
    WorkerPool(queue, keys, jobs, on_done).run()


def slurm_script(queue: Queue, shards: int) -> str:
    """Returns the script of an array job of ``shards`` tasks, each of which grades its share of the queue."""
    command = [sys.executable, "-P", "-m", "grader", "work", str(queue.folder.absolute())]
    return job_executors.slurm_script(queue.folder, command, shards, "grader")


def run_on_slurm(queue: Queue, shards: int) -> None:
    """Submits the array job and waits until it is over. Raises ExecutorUnavailable."""
    job_executors.run_on_slurm(queue.folder, slurm_script(queue, shards), lambda: bool(queue.waiting()))


def run_on_dask(queue: Queue, keys: Sequence[str], address: str, on_done: Callable[[str], None]) -> None:
    """Grades the jobs on a Dask cluster whose machines all see the queue folder. Raises ExecutorUnavailable.

    Only keys are sent. A job that repeatedly kills its worker gets no grade; the others go on.
    """
    lost = partial(record_incident, queue)
    job_executors.run_on_dask(queue.folder, grade_job_by_key, keys, address, on_done, lost)


def grade_job_by_key(folder: str, key: str) -> str:
    """Grades one job, given by strings alone, as Dask sends them."""
    grade_job(Queue(Path(folder)), key)
    return key
