"""A class that is graded without a program being run: a queue whose results are written as a worker would write them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from grader.cohort.queue import Queue, prepare_queue
from grader.grading import GradingOptions
from grader.reading import read_assignment
from grader.version import grader_version
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import PUBLIC_SEEDS, CriterionResult, CriterionStatus, GradingResult
from tests.grader.conftest import write_assignment

OPTIONS = GradingOptions(Level.LIMITED, may_lower_level=False)


def graded_queue(folder: Path, works: Mapping[str, float]) -> Queue:
    """Grades a class for ``QUICK``, whose works by name earn these shares of its 6 points. Works of the same share are equal."""
    assignment = read_assignment(write_assignment(folder / "quick"))
    handed_in = folder / "in"
    handed_in.mkdir()
    for name, share in works.items():
        work = handed_in / name
        if work.suffix != ".py":
            work.mkdir()
            work = work / "controller.py"
        work.write_text(f"SHARE = {share}\n")
    queue = Queue(folder / "queue")
    for entry in prepare_queue(queue, handed_in, assignment, OPTIONS):
        if entry.key is None:
            continue
        submission = queue.submission(entry.key)
        share = float(submission.files[submission.main].decode().partition("= ")[2])
        tests = tuple(
            CriterionResult(
                each.id,
                each.title,
                CriterionStatus.PASS if share == 1 else CriterionStatus.PARTIAL,
                round(each.points * share, 6),
                each.points,
                rationale="" if share == 1 else f"“{each.title}” is not met.",
                hints=() if share == 1 else ("Look.",),
                replay="" if share == 1 else "#####\n#  x#\n#####",
            )
            for each in assignment.tests
        )
        result = GradingResult(
            assignment.id,
            assignment.version,
            submission.digest,
            grader_version(),
            PUBLIC_SEEDS,
            int(Level.LIMITED),
            "test",
            tests,
            public_version=assignment.public_version,
        )
        queue.save_result(entry.key, result)
    return queue
