"""Annotations of a GitHub workflow, beside the student's lines."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import Final

from grader.reports.cleaning import clean_line, plain
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import GradingResult
from kit.results.result_blocks import points_text

MAX_ANNOTATIONS: Final = 10
"""Of each kind; GitHub shows no more of one step."""
_PLACE: Final = re.compile(r"(?P<file>[A-Za-z0-9_./-]+):(?P<line>\d+): ")


def write_annotations(result: GradingResult, work: str = "") -> str:
    """Writes GitHub's workflow commands: an annotation for each lost criterion, at the student's line where one is known.

    ``work``: the file or folder that was graded, relative to the repository.
    """
    result = result.for_student()
    lines = []
    for test in result.tests:
        if test.is_passed or not test.is_judged:
            continue
        place = _PLACE.match(test.rationale)
        where = {"title": clean_line(f"{test.title}: {points_text(test.points, test.max_points)}", 120)}
        if place is not None:
            folder = work if work and not PurePosixPath(work).suffix else str(PurePosixPath(work).parent)
            where = {"file": str(PurePosixPath(folder) / place["file"]), "line": place["line"], **where}
        told = ",".join(f"{key}={_escape(value, is_property=True)}" for key, value in where.items())
        text = _escape(plain("\n".join((test.rationale, *test.hints[:1])), 1000))
        lines.append(f"::{'warning' if test.points else 'error'} {told}::{text}")
    kinds = {
        kind: [line for line in lines if line.startswith(f"::{kind}")][:MAX_ANNOTATIONS]
        for kind in ("error", "warning")
    }
    points = (
        "no grade" if result.points is None else f"{points_text(result.points, result.max_points)} points"
    )
    later = [test.title for test in result.tests if test.is_withheld]
    points += f"; shown later: {clean_line(', '.join(later))}" if later else ""
    kinds["notice"] = [
        f"::notice title={_escape(clean_line(result.assignment), is_property=True)}::{_escape(points)}"
    ]
    return "".join(f"{line}\n" for each in kinds.values() for line in each)


def _escape(text: str, *, is_property: bool = False) -> str:
    """What a workflow command may hold: nothing in it ends the command, or begins another."""
    for sign, code in (("%", "%25"), ("\r", "%0D"), ("\n", "%0A")):
        text = text.replace(sign, code)
    return text.replace(":", "%3A").replace(",", "%2C") if is_property else text


FORMAT: Final = ReportFormat("annotations", write_annotations)
