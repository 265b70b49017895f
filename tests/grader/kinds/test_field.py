"""Charge files that are handed in: driven in, and harmless whatever they hold."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.assignment import Assignment
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict

ASSIGNMENT_TEXT = """
title: Charges
kind: field
submit: charges.yaml
level: 0
trials:
  - {name: there, place: turn, case: turn_a_to_b, time: 40, seeds: [1]}
checks:
  - {check: covers, points: 1, share: {none: 0.3, full: 0.99}}
  - {check: arrive, points: 1}
  - {check: bumps, points: 1, share: {none: 1, full: 0}}
  - {check: free_of_traps, points: 1}
  - {check: force_at, points: 1, with: {x: 0.0, y: 0.0, fx: FX, fy: FY}}
"""
GOOD = (
    Path(__file__).parents[2] / "solutions" / "13-potential-fields" / "corner" / "solution.yaml"
).read_text()


@pytest.fixture(scope="module")
def assignment(tmp_path_factory: pytest.TempPathFactory) -> Assignment:
    folder = tmp_path_factory.mktemp("charges")
    # By hand at (0, 0): the end pushes up by 1 / 0.22^2, the two side walls cancel, the target pulls.
    pull = 15 / (2 * 1.6**2) / 2**0.5
    sheet = ASSIGNMENT_TEXT.replace("FX", f"{pull}").replace("FY", f"{pull + 1 / 0.22**2}")
    (folder / "assignment.yaml").write_text(sheet)
    return read_assignment(folder)


def handed_in(assignment: Assignment, text: str) -> GradingResult:
    return grade(
        assignment,
        Submission("ada", "charges.yaml", {"charges.yaml": text.encode()}),
        GradingOptions(Level.LIMITED, secret=True),
    )


def test_a_good_layout_earns_everything(assignment: Assignment) -> None:
    result = handed_in(assignment, GOOD)
    assert [test.rationale for test in result.tests if test.status is not CriterionStatus.PASS] == []
    assert result.verdict is GradingVerdict.PASS


@pytest.mark.parametrize(
    ("before", "after", "lost"),
    [
        ("walls: -1\n  target: 15", "walls: 0\n  target: 5.0e-324", {"covers", "bumps"}),
        ("  - line", "  - times: 0.001\n    line", {"covers"}),
    ],
    ids=["no charge acts, and the robot stands", "some charges do not act"],
)
def test_a_charge_counts_if_it_acts_and_a_drive_if_it_goes_somewhere(
    assignment: Assignment, before: str, after: str, lost: set[str]
) -> None:
    assert before in GOOD
    result = handed_in(assignment, GOOD.replace(before, after))
    shares = {test.id: test.points for test in result.tests}
    assert all(shares[each] == 0 for each in lost)
    if "bumps" in lost:
        assert "It hardly drove, 0.00 m" in next(
            test.rationale for test in result.tests if test.id == "bumps"
        )


@pytest.mark.long
def test_a_trap_is_told_with_its_place(assignment: Assignment) -> None:
    result = handed_in(assignment, GOOD.replace("target: 15", "target: 0.5"))
    said = {test.id: test.rationale for test in result.tests}
    assert "trap at" in said["arrive"]
    assert not said["covers"]


ALIASES = "a: &a [1, 1]\n" + "".join(
    f"{chr(98 + n)}: &{chr(98 + n)} [{', '.join(['*' + chr(97 + n)] * 9)}]\n" for n in range(9)
)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "charges: [",
        "- 1\n",
        GOOD.replace("target", "targt"),
        GOOD.replace("target: 15", "target: -1"),
        GOOD.replace("target: 15", "target: .nan"),
        GOOD.replace("walls: -1", "walls: -1e300"),
        GOOD.replace("walls: -1", "walls: -1000001"),
        GOOD.replace("[0.42, 1.22]\n", "[.inf, 1.22]\n"),
        GOOD.replace("      - point: [0.42, 1.22]\n", ""),
        GOOD.replace("- line: [-0.42, -0.22, 0.42, -0.22]", "- line: [0, 0, 0, 0]"),
        GOOD.replace("- line: [-0.42, -0.22, 0.42, -0.22]", "- line: [5, 5, 6, 6]"),
        GOOD + "  - point: [0, 1]\n" * 300,
        "intensities: {target: !!python/object/apply:os.system [ls]}\n",
        ALIASES,
        "#" * 70_000,
    ],
    ids=[
        *(
            "empty",
            "broken",
            "list",
            "key",
            "sign",
            "nan",
            "huge",
            "strong",
            "infinite",
            "open",
            "length",
            "wall",
        ),
        *("many", "tag", "aliases", "large"),
    ],
)
def test_what_is_no_layout_is_told_and_harms_nobody(assignment: Assignment, text: str) -> None:
    result = handed_in(assignment, text)
    assert result.verdict is GradingVerdict.FAIL
    assert {test.status for test in result.tests} == {CriterionStatus.STUDENT_ERROR}
    assert result.tests[0].rationale
    assert "/tmp" not in result.tests[0].rationale
