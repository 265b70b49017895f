"""What the outcomes of a teacher's test are worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from grader.assignment import TeacherTest
from grader.scoring import DEFAULT_STEPS, round_share
from grader.teacher_tests.running import TestOutcome
from kit.results.grading_result import CriterionResult, CriterionStatus

NOT_LOST: Final = (CriterionStatus.PASS, CriterionStatus.SKIPPED)


def teacher_test_result(test: TeacherTest, outcomes: Sequence[TestOutcome]) -> CriterionResult:
    """Makes the result of one test; each outcome of a parametrized test is worth its share.

    A test that may have seen secret evidence pays in steps, and its own message is the teacher's alone.
    """
    statuses = [outcome.status for outcome in outcomes]
    uses_secrets = any(outcome.uses_secrets for outcome in outcomes)
    blank = CriterionResult(test.id, test.title, CriterionStatus.SKIPPED, 0.0, test.points, test.visibility)
    blank = replace(blank, uses_secrets=uses_secrets)
    if not outcomes or CriterionStatus.GRADER_ERROR in statuses:
        log = next(
            (each.message for each in outcomes if each.status is CriterionStatus.GRADER_ERROR),
            "It did not run.",
        )
        broken = "The grader failed here. This is not your fault and costs no points; your teacher will be informed."
        return replace(blank, status=CriterionStatus.GRADER_ERROR, rationale=broken, log=log)
    if set(statuses) == {CriterionStatus.SKIPPED}:
        reason = outcomes[0].message
        return replace(blank, teacher_note=reason) if uses_secrets else replace(blank, rationale=reason)
    judged = [status for status in statuses if status is not CriterionStatus.SKIPPED]
    share = judged.count(CriterionStatus.PASS) / len(judged)
    if uses_secrets:
        share = round_share(share, DEFAULT_STEPS)
    if share == 1.0:
        return replace(blank, status=CriterionStatus.PASS, points=test.points)
    message = next((each.message for each in outcomes if each.status not in NOT_LOST and each.message), "")
    text = test.feedback if uses_secrets else message or test.feedback
    return replace(
        blank,
        status=CriterionStatus.PARTIAL if share > 0 else _status_of_lost(statuses),
        points=round(test.points * share, 6),
        rationale=text or f"“{test.title}” does not hold.",
        hints=test.hints,
        teacher_note=message if uses_secrets else "",
    )


def _status_of_lost(statuses: Sequence[CriterionStatus]) -> CriterionStatus:
    """Returns why a test has earned nothing: the program's failure where all outcomes come from it."""
    lost = {status for status in statuses if status not in NOT_LOST}
    return lost.pop() if len(lost) == 1 else CriterionStatus.FAIL
