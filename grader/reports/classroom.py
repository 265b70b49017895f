"""GitHub Classroom's runner result (version 3): the JSON whose base64 is a step's output ``result``.

``tests`` and ``max_score`` are always there, for its reporter reads them even when the run failed.
"""

from __future__ import annotations

import json
from typing import Any, Final

from grader.reports.cleaning import one_line, plain
from kit.school.result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict, format_points

LONGEST: Final = 500
"""Characters of output that Classroom keeps."""


def write(result: GradingResult) -> str:
    result = result.for_student()  # the log of the job is the student's to read
    content: dict[str, Any] = {
        "version": 3,
        "status": {GradingVerdict.PASS: "pass", GradingVerdict.FAIL: "fail", GradingVerdict.BROKEN: "error"}[
            result.verdict
        ],
        "max_score": round(result.max_points),
        "tests": [] if result.verdict is GradingVerdict.BROKEN else [_test(test) for test in result.tests],
    }
    if result.verdict is GradingVerdict.BROKEN:
        content["message"] = "The grader broke. Nothing was lost: tell your teacher."
    return json.dumps(content, separators=(",", ":"), allow_nan=False)


def _test(test: CriterionResult) -> dict[str, Any]:
    return {
        "name": f"{one_line(test.title, 120)} ({format_points(test.points)}/{format_points(test.max_points)})",
        "status": "pass" if test.status is CriterionStatus.PASS else "fail",
        "score": test.points,
        "message": one_line(test.rationale, LONGEST - 20),
        "output": plain("\n".join(part for part in (test.rationale, *test.hints[:1]) if part), LONGEST - 20),
        "duration": 0,
    }
