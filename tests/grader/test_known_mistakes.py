"""Hints chosen by the mistake: told from the feedback, the measure, or what was met."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import GradingResult
from kit.world.problems import WorldError
from tests.grader.conftest import write_assignment

SHEET = """
title: Two words
kind: function
submit: words.py
level: 0
functions: [{name: half}, {name: twice}]
checks:
  - {check: agrees, id: half, points: 1, with: {function: half}, hints: [what half is]}
  - check: agrees
    id: twice
    points: 1
    with: {function: twice}
    hints: [general, nearly how]
    mistakes: [MISTAKE]
"""
REFERENCE = """
def half(x): return x / 2
def half_cases(random): yield {"x": 3.0}
def twice(x): return 2 * x
def twice_cases(random): yield {"x": 3.0}; yield {"x": 0.0}
"""
GOOD_HALF = "def half(x): return x / 2\n"
WRONG_HALF = "def half(x): return x\n"
SQUARE = "def twice(x): return x * x\n"
"""Right for 0, so that half of the cases agree."""


@pytest.mark.parametrize(
    ("first", "second", "is_read"),
    [
        ("visible", "visible", True),
        ("hidden", "hidden", True),
        ("visible", "hidden", True),
        ("hidden", "visible", False),
        ("after_published", "after_due", False),
    ],
)
def test_a_hint_tells_nothing_of_a_criterion_that_is_shown_later(
    first: str, second: str, is_read: bool, tmp_path: Path
) -> None:
    sheet = SHEET.replace("MISTAKE", "{passed: half, hint: halves}")
    sheet = sheet.replace("{check: agrees, id: half,", f"{{check: agrees, id: half, visibility: {first},")
    sheet = sheet.replace("    id: twice\n", f"    id: twice\n    visibility: {second}\n")
    folder = write_assignment(tmp_path / "task", sheet)
    (folder / "reference.py").write_text(REFERENCE)
    if is_read:
        read_assignment(folder)
        return
    with pytest.raises(WorldError, match="passed"):
        read_assignment(folder)


def graded(folder: Path, mistake: str, source: str) -> GradingResult:
    task = write_assignment(folder / "task", SHEET.replace("MISTAKE", mistake))
    (task / "reference.py").write_text(REFERENCE)
    work = folder / "words.py"
    work.write_text(source)
    assignment = read_assignment(task)
    return grade(assignment, read_submission(work, assignment.submit), GradingOptions(Level.LIMITED))


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("mistake", "source", "is_made"),
    [
        ("{from: 0.4, to: 0.6, hint: told}", GOOD_HALF + SQUARE, True),
        ("{from: 0.9, hint: told}", GOOD_HALF + SQUARE, False),
        ("{when: RETURNS WHAT IT SHOULD, hint: told}", GOOD_HALF + SQUARE, True),
        ("{when: no such text, hint: told}", GOOD_HALF + SQUARE, False),
        ("{passed: half, hint: told}", GOOD_HALF + SQUARE, True),
        ("{passed: half, hint: told}", WRONG_HALF + SQUARE, False),
    ],
)
def test_a_hint_for_the_mistake_comes_first(tmp_path: Path, mistake: str, source: str, is_made: bool) -> None:
    lost = graded(tmp_path, mistake, source).tests[1]
    assert not lost.is_passed
    assert lost.hints == (("told", "general", "nearly how") if is_made else ("general", "nearly how"))


@pytest.mark.parametrize("mistake", ["{hint: told}", "{when: x}", "{passed: later, hint: told}"])
def test_a_mistake_that_cannot_be_told_is_refused(tmp_path: Path, mistake: str) -> None:
    with pytest.raises(WorldError, match=r"assignment\.yaml:14"):
        graded(tmp_path, mistake, GOOD_HALF + SQUARE)


def test_a_mistake_that_was_described_before_needs_no_hint(tmp_path: Path) -> None:
    both = graded(tmp_path, "{when: x, hint: told}", "def half(x): return\ndef twice(x: return\n").tests
    assert both[1].rationale.startswith("The same mistake as in")
    assert both[1].hints == ()


@pytest.mark.parametrize(
    ("half", "hints"),
    [
        ("def half(x): return x /", ()),
        ("def half(x): return y / 2", ()),
        ("def half(x): return x / 0", ("what half is",)),
    ],
)
def test_a_slip_gets_no_hint_about_the_task(tmp_path: Path, half: str, hints: tuple[str, ...]) -> None:
    (first, _) = graded(tmp_path, "{when: x, hint: told}", f"{half}\n{SQUARE}").tests
    assert not first.is_passed
    assert first.hints == hints
