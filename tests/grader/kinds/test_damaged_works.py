"""A right work of every kind, damaged in many ways: it costs its own points, and nothing looks like a fault of the
grader's."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import pytest

from grader.assignment import Assignment
from grader.grading import GradingOptions, grade
from grader.kinds.contract import kind_names
from grader.new_assignment import example_of_kind, make_assignment
from grader.reading import read_assignment
from grader.submission import Submission, read_submission
from grader.submitted_files import SubmissionRefused
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict

LESSONS = Path(__file__).parents[3] / "lessons"
SOLUTIONS = Path(__file__).parents[2] / "solutions"


def flipped(content: bytes) -> bytes:
    """Every 37th byte is another one."""
    rng, changed = random.Random(37), bytearray(content)
    for place in range(17, len(changed), 37):
        changed[place] ^= rng.randrange(1, 255)
    return bytes(changed)


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "cut in half": lambda content: content[: len(content) // 2],
    "flipped bytes": flipped,
    "backwards": lambda content: content[::-1],
    "zeros": lambda content: bytes(1000),
    "noise": lambda content: random.Random(1).randbytes(3000),
    "brackets": lambda content: b"[" * 50_000,
    "parentheses": lambda content: b"(" * 50_000,
    "half characters": lambda content: b"\xed\xa0\x80" * 50,
    "one long line": lambda content: b"x" * 500_000,
    "colons": lambda content: b": " * 20_000,
}
QUICK = ("drive", "plan", "policy")
"""Kinds that start no process and no world for a damaged work."""


def right_work(kind: str, folder: Path) -> tuple[Assignment, Submission]:
    """The first exercise of a kind in the lessons, where none asks for it the kind's example; and its solution."""
    for file in sorted(LESSONS.glob("*/*/assignment.yaml")):
        assignment = read_assignment(file.parent)
        found = sorted((SOLUTIONS / file.parent.relative_to(LESSONS)).glob("solution*"))
        if assignment.kind == kind and found:
            return assignment, read_submission(found[0], assignment.submit)
    make_assignment(example_of_kind(kind), folder / "example")
    assignment = read_assignment(folder / "example")
    (solution,) = (folder / "example").glob("solution*")
    return assignment, read_submission(solution, assignment.submit)


def is_skipped(result: GradingResult) -> bool:
    """Whether nothing was judged."""
    return all(test.status is CriterionStatus.SKIPPED for test in result.tests)


@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=[pytest.mark.long] * (kind not in QUICK)) for kind in kind_names()]
)
def test_damage_is_the_works_own(kind: str, tmp_path: Path) -> None:
    assignment, right = right_work(kind, tmp_path)
    for name, damage in DAMAGES.items():
        folder = tmp_path / "works" / name.replace(" ", "_")
        for file, content in right.files.items():
            path = folder / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(damage(content) if file == right.main else content)
        try:
            work = read_submission(folder, assignment.submit)
            result = grade(assignment, work, GradingOptions(Level.LIMITED))
            if is_skipped(result):  # what is right stands in secret.yaml
                result = grade(assignment, work, GradingOptions(Level.LIMITED, secret=True))
        except SubmissionRefused:
            continue
        assert not is_skipped(result), name
        assert result.verdict is GradingVerdict.FAIL, name
        assert all(test.rationale for test in result.tests if test.points < test.max_points), name
