"""PrairieLearn: ``results.json``."""

from __future__ import annotations

import json
from typing import Any, Final

from grader.reports.cleaning import clean_line, plain
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict
from kit.results.result_blocks import rounded_points

NOT_RUN: Final = (CriterionStatus.STUDENT_ERROR, CriterionStatus.SKIPPED)


def write_prairielearn(result: GradingResult) -> str:
    """Writes PrairieLearn's ``results.json``. Work that could not run at all is not gradable, which costs no attempt."""
    result = result.for_student()
    content: dict[str, Any] = {"gradable": True, "output": plain("\n".join(result.notices))}
    stopped = all(test.status in NOT_RUN for test in result.tests) and any(
        test.status is CriterionStatus.STUDENT_ERROR for test in result.tests
    )
    if result.verdict is GradingVerdict.BROKEN:
        content |= {"gradable": False, "message": "The grader failed. You lost no points: tell your teacher."}
    elif stopped:
        first = next(test for test in result.tests if test.status is CriterionStatus.STUDENT_ERROR)
        content |= {"gradable": False, "format_errors": [plain(first.rationale)]}
    else:
        most = result.max_points
        content["score"] = 0.0 if not most or result.points is None else min(1.0, result.points / most)
        content["tests"] = [_prairielearn_test(test) for test in result.tests]
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _prairielearn_test(test: CriterionResult) -> dict[str, Any]:
    points = (
        {} if test.is_withheld else {"points": rounded_points(test.points), "max_points": test.max_points}
    )
    return {
        "name": clean_line(test.title),
        "description": clean_line(test.rationale),
        **points,
        "message": plain("\n".join(f"hint: {hint}" for hint in test.hints[:1])),
        "output": plain(test.log) + (f"\n{test.replay}" if test.replay else ""),
    }


FORMAT: Final = ReportFormat("prairielearn", write_prairielearn)
