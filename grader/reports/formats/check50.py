"""JSON as check50 writes it."""

from __future__ import annotations

import json
from typing import Any, Final

from grader.reports.cleaning import clean_line, plain
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import CriterionResult, CriterionStatus, GradingResult
from kit.results.result_blocks import rounded_points


def write_check50(result: GradingResult) -> str:
    """Writes JSON as check50 does: ``passed`` is true, false, or null where nothing is known."""
    result = result.for_student()
    content = {
        "slug": clean_line(result.assignment),
        "version": result.grader_version,
        "results": [_check50_test(test) for test in result.tests],
    }
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _check50_test(test: CriterionResult) -> dict[str, Any]:
    cause: dict[str, Any] | None = None
    if test.status is not CriterionStatus.PASS:
        cause = {"rationale": plain(test.rationale), "help": plain(test.hints[0]) if test.hints else None}
        if test.actual:
            cause |= {"expected": clean_line(test.expected), "actual": clean_line(test.actual)}
    return {
        "name": clean_line(test.id),
        "description": clean_line(test.title),
        "passed": test.status is CriterionStatus.PASS if test.is_judged else None,
        "log": plain(test.log).splitlines()[:100],
        "cause": cause,
        "data": {}
        if test.is_withheld
        else {"points": rounded_points(test.points), "max_points": test.max_points, **test.metrics},
        "dependency": test.depends_on,
    }


FORMAT: Final = ReportFormat("check50", write_check50)
