"""JSON in the manner of check50: passed is true, false, or null where nothing is known."""

from __future__ import annotations

import json
from typing import Any

from grader.reports.cleaning import one_line, plain
from kit.school.result import CriterionResult, CriterionStatus, GradingResult


def write(result: GradingResult) -> str:
    result = result.for_student()
    content = {
        "slug": one_line(result.assignment),
        "version": result.grader_version,
        "results": [_test(test) for test in result.tests],
    }
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _test(test: CriterionResult) -> dict[str, Any]:
    cause: dict[str, Any] | None = None
    if test.status is not CriterionStatus.PASS:
        cause = {"rationale": plain(test.rationale), "help": plain(test.hints[0]) if test.hints else None}
        if test.actual:
            cause |= {"expected": one_line(test.expected), "actual": one_line(test.actual)}
    return {
        "name": one_line(test.id),
        "description": one_line(test.title),
        "passed": test.status is CriterionStatus.PASS if test.is_judged else None,
        "log": plain(test.log).splitlines()[:100],
        "cause": cause,
        "data": {"points": test.points, "max_points": test.max_points, **test.metrics},
        "dependency": test.depends_on,
    }
