"""Whatever number a program returns or sends, it costs its own points: no error of the grader's, and no calculation without
an end."""

from __future__ import annotations

import math
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from grader.evidence.submission_clock import SubmissionClock
from grader.grading import GradingOptions, grade
from grader.kinds.reward.behaviours import compare_behaviours, compare_loops
from grader.kinds.reward.optimal_policy import value_iteration
from grader.kinds.reward.task_model import build_model
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.failure import StudentCodeError
from kit.host.sandbox.sandbox_config import Level
from kit.learning.tasks.student_reward import LARGEST_REWARD
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from tests.cases import every_case
from tests.grader.attack import REWARD_SHEET
from tests.grader.conftest import FORWARD, write_assignment
from tests.grader.further_attacks import FUNCTION_SHEET, REFERENCE

ODD_VALUES = {
    "nan": "float('nan')",
    "infinity": "float('inf')",
    "minus infinity": "-float('inf')",
    "minus zero": "-0.0",
    "subnormal": "5e-324",
    "the largest float": "1.7976931348623157e308",
    "both largest floats": "next(signs) * 1.7e308",
    "a large number of both signs": "next(signs) * 1e9",
    "more than an integer holds": "2**64",
    "more than a float holds": "10**400",
    "more digits than are written": "10**5000",
    "true": "True",
    "nothing": "None",
    "a text": "'1'",
    "a complex number": "1j",
    "a list": "[0.0]",
    "an empty list": "[]",
    "a list in a list": "[[[[0.0]]]]",
    "an array": "__import__('numpy').zeros(3)",
    "an array without dimensions": "__import__('numpy').float64('nan')",
    "an array of texts": "__import__('numpy').array(['a'])",
    "half a float": "__import__('numpy').float16('inf')",
    "a number of a class of its own": "type('N', (float,), {})(1.0)",
    "a decimal": "__import__('decimal').Decimal('NaN')",
    "a fraction": "__import__('fractions').Fraction(1, 3)",
}
"""Expressions; ``signs`` yields 1 and -1 in turn."""
SIGNS = "import itertools\nsigns = itertools.cycle((1, -1))\n"
DESK = GradingOptions(Level.LIMITED)


def judged(folder: Path, source: str) -> GradingResult:
    assignment = read_assignment(folder)
    return grade(assignment, Submission("ada", assignment.submit, {assignment.submit: source.encode()}), DESK)


def check_honest(result: GradingResult) -> None:
    assert result.verdict is not GradingVerdict.BROKEN, [each.log for each in result.tests]
    for test in result.tests:
        assert math.isfinite(test.points)
        assert test.rationale or test.points == test.max_points


@pytest.mark.long
@every_case("value", ODD_VALUES.values(), ids=ODD_VALUES)
def test_whatever_a_reward_returns(value: str, tmp_path: Path) -> None:
    folder = tmp_path / "r"
    if not folder.exists():
        write_assignment(folder, REWARD_SHEET)
    check_honest(judged(folder, f"{SIGNS}def reward(to_go): return {value}\n"))


@pytest.mark.long
@every_case("value", ODD_VALUES.values(), ids=ODD_VALUES)
def test_whatever_a_function_returns(value: str, tmp_path: Path) -> None:
    folder = tmp_path / "f"
    if not folder.exists():
        write_assignment(folder, FUNCTION_SHEET)
        (folder / "reference.py").write_bytes(REFERENCE["reference.py"])
    check_honest(judged(folder, f"{SIGNS}def half(x): return {value}\n"))


@pytest.mark.long
@every_case("value", ODD_VALUES.values(), ids=ODD_VALUES)
def test_whatever_a_controller_sends(value: str, tmp_path: Path) -> None:
    folder = tmp_path / "c"
    if not folder.exists():
        write_assignment(folder)
    source = SIGNS + FORWARD.replace("SPEED = 0.3", f"SPEED = {value}")
    assert value in source
    check_honest(judged(folder, source))


@pytest.mark.parametrize("seconds", [0.0, 0.05])
def test_a_calculation_ends_with_the_submissions_time(seconds: float, tmp_path: Path) -> None:
    grid = REWARD_SHEET.replace("discount: 0.95, max_steps: 40", "discount: 0.999, max_steps: 10000")
    model = build_model(read_assignment(write_assignment(tmp_path / "r", grid)).task)
    rewards = np.where(np.arange(model.states * 4).reshape(-1, 4) % 2, LARGEST_REWARD, -LARGEST_REWARD)
    for calculate in (value_iteration, compare_behaviours, compare_loops):
        clock, began = SubmissionClock(seconds), time.process_time()
        while not clock.is_used_up:  # however fast this machine is
            with suppress(StudentCodeError):
                calculate(model, rewards, clock.check)
        with pytest.raises(StudentCodeError):
            calculate(model, rewards, clock.check)
        assert time.process_time() - began < 20


def test_what_takes_too_long_to_measure_is_the_submissions_timeout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not a fault of the grader's: that would leave it without a grade."""
    folder = write_assignment(tmp_path / "r", REWARD_SHEET)
    used_up: list[bool] = []
    is_used_up = SubmissionClock.is_used_up.fget
    monkeypatch.setattr(
        SubmissionClock,
        "is_used_up",
        property(lambda clock: bool(used_up) or is_used_up(clock)),  # type: ignore[misc]  # a property has it
    )
    monkeypatch.setattr(
        "grader.kinds.reward.evidence.RewardEvidence.is_pure",
        property(lambda evidence: used_up.append(True) or True),
    )
    result = judged(folder, "def reward(reached): return 1.0 * reached\n")
    statuses = {test.id: test.status for test in result.tests}
    assert statuses == {
        "contract": CriterionStatus.PASS,
        "pure": CriterionStatus.PASS,
        "planned": CriterionStatus.TIMEOUT,
    }
    assert "used up" in result.tests[2].rationale
