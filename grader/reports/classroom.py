"""GitHub Classroom's runner result (version 3): the JSON whose base64 is a step's output ``result``.

``tests`` and ``max_score`` are always there, for its reporter reads them even when the run failed.
"""

from __future__ import annotations

import json
from typing import Any, Final

from grader.reports.cleaning import one_line, plain
from grader.result import Result, Status, Test, Verdict, amount

LONGEST: Final = 500
"""Characters of output that Classroom keeps."""


def write(result: Result) -> str:
    result = result.for_student()  # the log of the job is the student's to read
    content: dict[str, Any] = {
        "version": 3,
        "status": {Verdict.PASS: "pass", Verdict.FAIL: "fail", Verdict.BROKEN: "error"}[result.verdict],
        "max_score": round(result.max_points),
        "tests": [] if result.verdict is Verdict.BROKEN else [_test(test) for test in result.tests],
    }
    if result.verdict is Verdict.BROKEN:
        content["message"] = "The grader broke. Nothing was lost: tell your teacher."
    return json.dumps(content, separators=(",", ":"), allow_nan=False)


def _test(test: Test) -> dict[str, Any]:
    return {
        "name": f"{one_line(test.title, 120)} ({amount(test.points)}/{amount(test.max_points)})",
        "status": "pass" if test.status is Status.PASS else "fail",
        "score": test.points,
        "message": one_line(test.rationale, LONGEST - 20),
        "output": plain("\n".join(part for part in (test.rationale, *test.hints[:1]) if part), LONGEST - 20),
        "duration": 0,
    }
