"""One submission, one assignment, one result."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from grader.assignment import Assignment
from grader.grading import Grading
from grader.hardening import hide_process
from grader.kinds.contract import EvidenceOptions, find_kind
from grader.submission import Submission
from kit.host.sandbox.confinement import Level
from kit.school.result import GradingResult


class LevelTooLow(Exception):
    """Secrets would be used at a lower confinement than the assignment allows; the message says what to do."""


@dataclass(frozen=True, slots=True)
class GradingOptions:
    """How to grade."""

    level: Level | None = None
    """How far to lock programs in; None: as the assignment says."""
    secret: bool = False
    """Whether the secret seeds are used: for the grade."""
    may_fall: bool = True
    """Whether practice goes on at a lower level where the machine has none higher."""


@contextmanager
def open_grading(assignment: Assignment, submission: Submission, terms: GradingOptions) -> Iterator[Grading]:
    """A grading, ready to judge. Raises LevelTooLow."""
    level = assignment.level if terms.level is None else terms.level
    if terms.secret and level < assignment.level:
        raise LevelTooLow(
            f"{assignment.title} uses its secret seeds at confinement level {int(assignment.level)} or higher, "
            f"not at {int(level)}. `kit doctor` says what this machine can do."
        )
    hide_process()
    with submission.in_temporary_folder() as file:
        options = EvidenceOptions(level, terms.secret, terms.may_fall and terms.level is None)
        with find_kind(assignment.kind).collect(assignment, file, options) as collector:
            yield Grading(assignment, submission, collector, secret=terms.secret)


def grade(assignment: Assignment, submission: Submission, terms: GradingOptions) -> GradingResult:
    """The result of one submission. Raises LevelTooLow."""
    with open_grading(assignment, submission, terms) as grading:
        return grading.result()
