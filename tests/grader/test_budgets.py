"""Every key of an assignment's budget is hit by a program, and the verdict is the student's."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.budgets import BUDGET_KEYS, SUBMISSION_KEY
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingVerdict
from tests.grader.conftest import LOCKS, write_assignment

SHEET = """
title: One function
kind: function
submit: work.py
level: 0
functions: [{{name: f}}]
checks: [{{check: agrees, points: 1}}]
budget: {{{budget}}}
"""
REFERENCE = """
def f(number):
    return number

def f_cases(chance):
    for number in range(4000):
        yield {"number": number}
"""
FOR_EVER = "while True: pass"
PROGRAMS = {
    # key: the budget, the program, the status, a word of the message. Each would go on for ever.
    "start": ("start: 2", FOR_EVER, CriterionStatus.TIMEOUT, "within 2 s"),
    "reply": ("reply: 1", f"def f(number):\n    {FOR_EVER}", CriterionStatus.TIMEOUT, "within 1 s"),
    "total": (
        "reply: 60, total: 1",
        f"def f(number):\n    {FOR_EVER}",
        CriterionStatus.TIMEOUT,
        "total time of 1 s",
    ),
    "cpu": (
        "start: 120, reply: 60, cpu: 1",
        f"def f(number):\n    {FOR_EVER}",
        CriterionStatus.TIMEOUT,
        "1 s of processor time",
    ),
    "memory": (
        "reply: 60, memory: 512",
        "def f(number):\n    kept = []\n    while True: kept.append(bytearray(1 << 24))",
        CriterionStatus.RESOURCE_LIMIT,
        "512 MiB",
    ),
    "disk": (
        "reply: 60, disk: 4",
        "def f(number):\n    for each in range(32): open(f'{each}', 'wb').write(bytes(1 << 20))\n    "
        + FOR_EVER,
        CriterionStatus.RESOURCE_LIMIT,
        "4 MiB",
    ),
    "files": (
        "reply: 60, files: 20",
        "def f(number):\n    for each in range(100): open(f'{each}', 'wb').close()\n    " + FOR_EVER,
        CriterionStatus.RESOURCE_LIMIT,
        "20 files",
    ),
    "submission": (
        "start: 120, reply: 60, submission: 2",
        f"def f(number):\n    {FOR_EVER}",
        CriterionStatus.TIMEOUT,
        "2 s that a submission may take",
    ),
}


@pytest.mark.long
@LOCKS
@pytest.mark.parametrize("key", PROGRAMS)
def test_a_program_that_hits_it_fails_by_its_own_fault(key: str, tmp_path: Path) -> None:
    budget, program, status, words = PROGRAMS[key]
    folder = write_assignment(tmp_path / "one", SHEET.format(budget=budget))
    (folder / "reference.py").write_text(REFERENCE)
    work = Submission("ada", "work.py", {"work.py": program.encode()})
    result = grade(read_assignment(folder), work, GradingOptions(Level.FILTERED))
    (test,) = result.tests
    assert (test.status, test.points) == (status, 0.0), test.rationale
    assert words in test.rationale
    assert result.verdict is GradingVerdict.FAIL


def test_every_key_has_such_a_program(tmp_path: Path) -> None:
    """``messages`` needs a node: see test_episodes."""
    keys = {*PROGRAMS, "messages"}
    assert keys == {SUBMISSION_KEY, *(key.name for key in BUDGET_KEYS)}
    folder = write_assignment(
        tmp_path / "one",
        SHEET.format(
            budget=", ".join(f"{key}: 256" for key in keys if key not in ("start", "reply"))
            + ", start: 60, reply: 30"
        ),
    )
    (folder / "reference.py").write_text(REFERENCE)
    assignment = read_assignment(folder)
    assert (assignment.limits.files, assignment.limits.messages, assignment.submission_limit_s) == (
        256,
        256,
        256.0,
    )
