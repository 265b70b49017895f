"""Grades jobs: one at a time in this process, or many in worker processes that may die without harm."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import IO, Final

from grader.assignment import Assignment
from grader.cohort.queue import Queue
from grader.grading import grade
from grader.submitted_files import SubmissionRefused
from grader.version import grader_version
from kit.school.result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict

DONE: Final = "done"
MAX_TRIES: Final = 2
"""How often a job is tried when the grader breaks. A failure of the student's program is never retried."""
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
    for _ in range(MAX_TRIES - 1):
        if result.verdict is not GradingVerdict.BROKEN:
            break
        result = grade(assignment, submission, options)
    queue.save_result(key, result)
    return result


def serve_jobs(queue: Queue, keys: IO[str], output: IO[str]) -> None:
    """Grades the key on each input line, and writes the key to the output when its result is saved."""
    for line in keys:
        key = line.strip()
        grade_job(queue, key)
        output.write(f"{DONE} {key}\n")
        output.flush()


class WorkerPool:
    """Runs ``jobs`` worker processes. A worker that dies, or stands still, costs its job one try and nothing else."""

    def __init__(self, queue: Queue, keys: Sequence[str], jobs: int, on_done: Callable[[str], None]) -> None:
        self._queue = queue
        self._waiting = deque(keys)
        self._jobs = min(jobs, len(keys))
        self._on_done = on_done
        self._limit_s = MAX_TRIES * (queue.assignment().submission_limit_s + GRACE_S)
        self._lock = threading.Lock()
        self._problems: list[Exception] = []

    def run(self) -> None:
        """Runs until every key has a result. Raises OSError if results cannot be saved."""
        threads = [threading.Thread(target=self._run_worker) for _ in range(self._jobs)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if self._problems:
            raise self._problems[0]

    def _run_worker(self) -> None:
        """Feeds keys to one worker process, and replaces it when it dies."""
        worker: subprocess.Popen[str] | None = None
        try:
            while (key := self._next()) is not None:
                for attempt in range(MAX_TRIES):
                    worker = worker or self._start()
                    if self._is_done(worker, key):
                        break
                    _stop_worker(worker, now=True)
                    worker = None
                    if attempt == MAX_TRIES - 1:
                        record_incident(self._queue, key)
                with self._lock:
                    self._on_done(key)
        except Exception as error:  # noqa: BLE001  # a thread's error is raised where the threads were started
            self._problems.append(error)
        finally:
            if worker is not None:
                _stop_worker(worker)

    def _next(self) -> str | None:
        with self._lock:
            return self._waiting.popleft() if self._waiting and not self._problems else None

    def _start(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-P", "-m", "grader", "worker", str(self._queue.folder.absolute())],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def _is_done(self, worker: subprocess.Popen[str], key: str) -> bool:
        assert worker.stdin is not None
        assert worker.stdout is not None
        try:
            worker.stdin.write(f"{key}\n")
            worker.stdin.flush()
        except BrokenPipeError:
            return False
        # Each program has limits; this is for a grader that stands still itself.
        watchdog = threading.Timer(self._limit_s, worker.kill)
        watchdog.daemon = True
        watchdog.start()
        try:
            return worker.stdout.readline() == f"{DONE} {key}\n"
        finally:
            watchdog.cancel()


def _stop_worker(worker: subprocess.Popen[str], *, now: bool = False) -> None:
    """Closes a worker's input, so that it ends; with ``now``, kills it first."""
    if now:
        worker.kill()
    with worker, suppress(BrokenPipeError):
        assert worker.stdin is not None
        worker.stdin.close()


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
