"""Classroom 50: ``classroom50/result/v1``."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from datetime import UTC, datetime
from types import MappingProxyType
from typing import Final

from grader.reports.cleaning import clean_line
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import GradingResult
from kit.results.result_blocks import rounded_points

CLASSROOM50_VARIABLES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "classroom": "CLASSROOM",
        "assignment": "ASSIGNMENT",
        "submission": "SUBMISSION_TAG",
        "commit": "COMMIT_URL",
        "release": "RELEASE_URL",
        "review": "REVIEW_URL",
    }
)
"""What Classroom 50's runner says in the environment, by the key of the result."""


def write_classroom50(result: GradingResult) -> str:
    """Writes the ``result.json`` of Classroom 50 (``classroom50/result/v1``), inside its runner, which says in the environment
    what it is about, and stamps the owner itself.

    A broken grader writes no score: the runner refuses that, and nobody gets 0.
    """
    result = result.for_student()
    told = {key: os.environ.get(name, "") for key, name in CLASSROOM50_VARIABLES.items()}
    told["review"] = told["review"] or told["commit"]
    tests = [
        {
            "test-name": clean_line(test.title, 120) + (" (shown later)" if test.is_withheld else ""),
            "passed": test.is_passed,
            "score": _whole_if_possible(test.points),
            "max-score": _whole_if_possible(test.max_points),
        }
        for test in result.tests
    ]
    started = datetime.fromisoformat(result.timing.started) if result.timing.started else datetime.now(UTC)
    content = {
        "schema": "classroom50/result/v1",
        **told,
        "datetime": started.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "score": None if result.points is None else _whole_if_possible(result.points),
        "max-score": _whole_if_possible(result.max_points),
        "tests": tests,
    }
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def _whole_if_possible(points: float) -> float:
    rounded = rounded_points(points)
    return int(rounded) if float(rounded).is_integer() else rounded


FORMAT: Final = ReportFormat("classroom50", write_classroom50)
