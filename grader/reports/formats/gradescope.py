"""Gradescope: ``results.json``, in plain text, never HTML or markup."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

from grader.reports.cleaning import clean_line, plain
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import (
    CriterionResult,
    CriterionStatus,
    GradingResult,
    GradingVerdict,
    Visibility,
)
from kit.results.result_blocks import rounded_points

VISIBILITY_NAMES: Final[Mapping[Visibility, str]] = MappingProxyType(
    {
        Visibility.VISIBLE: "visible",
        Visibility.AFTER_DUE: "after_due_date",
        Visibility.AFTER_PUBLISHED: "after_published",
        Visibility.HIDDEN: "hidden",
    }
)


def write_gradescope(result: GradingResult) -> str:
    """Writes Gradescope's ``results.json``.

    Students see the tests whose visibility allows it: Gradescope withholds the others until it is time, and adds up the
    points by the same rules, so that no total is written where a test is not visible.

    A broken grader writes no score at all: Gradescope then reports the run as failed, and nobody gets 0.
    """
    result = result.without_secrets()
    content: dict[str, Any] = {
        "execution_time": round(result.timing.wall_s, 2),
        "output": plain("\n".join(result.notices)),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "extra_data": {
            "submission": result.submission,
            "assignment_version": result.assignment_version,
            "level": result.level,
            "seeds": result.seeds,
            "verdict": result.verdict.value,
        },
    }
    if result.verdict is GradingVerdict.BROKEN:
        content["output"] = "The grader failed. You lost no points: tell your teacher; it will run again."
    else:
        if all(test.visibility is Visibility.VISIBLE for test in result.tests):
            content["score"] = None if result.points is None else rounded_points(result.points)
        content["tests"] = [_test_entry(number, test) for number, test in enumerate(result.tests, 1)]
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _test_entry(number: int, test: CriterionResult) -> dict[str, Any]:
    parts = [test.rationale]
    if test.actual and test.status is not CriterionStatus.PASS:
        parts.append(f"expected {test.expected}, got {test.actual}")
    parts += [f"hint: {hint}" for hint in test.hints[:1]]
    if test.log and test.is_judged:
        parts.append(f"what it printed:\n{test.log}")
    # The picture is the grader's own; cleaning would destroy its layout.
    score = {} if test.is_withheld else {"score": rounded_points(test.points), "max_score": test.max_points}
    outcome = {"status": "passed" if test.status is CriterionStatus.PASS else "failed"}
    output = "\n".join(plain(part) for part in parts if part) + (f"\n\n{test.replay}" if test.replay else "")
    return {
        "name": clean_line(test.title),
        "number": str(number),
        **score,
        **({} if test.is_withheld else outcome),
        "output": output,
        "output_format": "text",
        "name_format": "text",
        "tags": [] if test.is_withheld else [test.status.value],
        "visibility": VISIBILITY_NAMES[test.visibility],
    }


FORMAT: Final = ReportFormat("gradescope", write_gradescope)
