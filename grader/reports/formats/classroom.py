"""GitHub Classroom: the result of a runner."""

from __future__ import annotations

import json
from typing import Any, Final

from grader.reports.cleaning import clean_line, plain
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict
from kit.results.result_blocks import format_points, rounded_points

MAX_CLASSROOM_OUTPUT: Final = 500
"""Characters of output that Classroom keeps."""


def write_classroom(result: GradingResult) -> str:
    """Writes GitHub Classroom's runner result (version 3): the JSON whose base64 is a step's output ``result``.

    ``tests`` and ``max_score`` are always present, since its reporter reads them even if the run failed.
    """
    result = result.for_student()  # the log of the job is the student's to read
    content: dict[str, Any] = {
        "version": 3,
        "status": {GradingVerdict.PASS: "pass", GradingVerdict.FAIL: "fail", GradingVerdict.BROKEN: "error"}[
            result.verdict
        ],
        "max_score": round(result.max_points),
        "tests": []
        if result.verdict is GradingVerdict.BROKEN
        else [_classroom_test(test) for test in result.tests],
    }
    if result.verdict is GradingVerdict.BROKEN:
        content["message"] = "The grader failed. You lost no points: tell your teacher."
    return json.dumps(content, separators=(",", ":"), allow_nan=False)


def _classroom_test(test: CriterionResult) -> dict[str, Any]:
    earned = f" ({format_points(test.points)}/{format_points(test.max_points)})"
    return {
        "name": clean_line(test.title, 120) + ("" if test.is_withheld else earned),
        "status": "" if test.is_withheld else "pass" if test.status is CriterionStatus.PASS else "fail",
        "score": rounded_points(test.points),
        "message": clean_line(test.rationale, MAX_CLASSROOM_OUTPUT - 20),
        "output": plain(
            "\n".join(part for part in (test.rationale, *test.hints[:1]) if part), MAX_CLASSROOM_OUTPUT - 20
        ),
        "duration": 0,
    }


FORMAT: Final = ReportFormat("classroom", write_classroom)
