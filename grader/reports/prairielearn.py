"""PrairieLearn's ``results.json``. Work that could not be run at all is not gradable, which costs no attempt."""

from __future__ import annotations

import json
from typing import Any, Final

from grader.reports.cleaning import one_line, plain
from kit.school.result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict

STOPPED: Final = (CriterionStatus.STUDENT_ERROR, CriterionStatus.SKIPPED)


def write(result: GradingResult) -> str:
    result = result.for_student()
    content: dict[str, Any] = {"gradable": True, "output": plain("\n".join(result.notices))}
    stopped = all(test.status in STOPPED for test in result.tests) and any(
        test.status is CriterionStatus.STUDENT_ERROR for test in result.tests
    )
    if result.verdict is GradingVerdict.BROKEN:
        content |= {"gradable": False, "message": "The grader broke. Nothing was lost: tell your teacher."}
    elif stopped:
        first = next(test for test in result.tests if test.status is CriterionStatus.STUDENT_ERROR)
        content |= {"gradable": False, "format_errors": [plain(first.rationale)]}
    else:
        most = result.max_points
        content["score"] = 0.0 if not most or result.points is None else min(1.0, result.points / most)
        content["tests"] = [_test(test) for test in result.tests]
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _test(test: CriterionResult) -> dict[str, Any]:
    return {
        "name": one_line(test.title),
        "description": one_line(test.rationale),
        "points": test.points,
        "max_points": test.max_points,
        "message": plain("\n".join(f"hint: {hint}" for hint in test.hints[:1])),
        "output": plain(test.log) + (f"\n{test.replay}" if test.replay else ""),
    }
