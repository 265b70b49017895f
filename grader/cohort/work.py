"""Grades jobs: one at a time in this process, or many in worker processes that may die without harm: local ones, those
of a SLURM job array, or of a Dask cluster."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Final

from grader.assignment import Assignment
from grader.cohort.queue import Queue
from grader.grading import grade
from grader.submitted_files import SubmissionRefused
from grader.version import grader_version
from kit.host import job_executors
from kit.host.job_executors import MAX_TRIES, JobPool
from kit.host.job_executors import ExecutorUnavailable as ExecutorUnavailable
from kit.school.result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict

GRACE_S: Final = 120.0
"""Wall clock that a worker gets for a job besides what the submission may take [s]: to start, to judge and to save."""


@cache
def _assignment(folder: Path, version: str) -> Assignment:
    return Queue(folder).assignment()


def grade_job(queue: Queue, key: str) -> GradingResult | None:
    """Grades one job and saves its result. Returns None, and saves why, if the work cannot be read."""
    try:
        return _grade_job(queue, key)
    except SubmissionRefused as refused:
        queue.save_unreadable(key, refused)
        return None


def _grade_job(queue: Queue, key: str) -> GradingResult:
    manifest = queue.manifest()
    assignment = _assignment(queue.folder, manifest["assignment_version"])
    submission, options = queue.submission(key), queue.grading_options()
    result = grade(assignment, submission, options)
    for _ in range(MAX_TRIES - 1):  # a failure of the student's program is never retried
        if result.verdict is not GradingVerdict.BROKEN:
            break
        result = grade(assignment, submission, options)
    queue.save_result(key, result)
    return result


class WorkerPool(JobPool):
    """Runs ``jobs`` worker processes. A worker that dies, or stands still, costs its job one try and nothing else."""

    def __init__(self, queue: Queue, keys: Sequence[str], jobs: int, on_done: Callable[[str], None]) -> None:
        super().__init__(
            [sys.executable, "-P", "-m", "grader", "worker", str(queue.folder.absolute())],
            keys,
            jobs,
            on_done,
            partial(record_incident, queue),
            MAX_TRIES * (queue.assignment().submission_limit_s + GRACE_S),
        )


def record_incident(queue: Queue, key: str) -> None:
    """Saves for a job that it has no grade, because its worker died every time."""
    queue.save_result(key, _incident_result(queue, key))


def _incident_result(queue: Queue, key: str) -> GradingResult:
    """Returns the result of a job whose worker died every time: no grade, and a notice to the teacher."""
    assignment, submission, options = queue.assignment(), queue.submission(key), queue.grading_options()
    tests = tuple(
        replace(
            CriterionResult(
                each.id, each.title, CriterionStatus.GRADER_ERROR, 0.0, each.points, each.visibility
            ),
            rationale="The grader died while it graded this. Nothing is lost; your teacher will be informed.",
        )
        for each in assignment.tests
    )
    return GradingResult(
        assignment.id,
        assignment.version,
        submission.digest,
        grader_version(),
        "public+secret" if options.secret else "public",
        int(options.level or 0),
        sys.platform,
        tests,
    )


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
