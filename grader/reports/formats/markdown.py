"""Markdown: the summary of a job."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from grader.reports.cleaning import escape_markdown, fenced_block
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import CriterionStatus, GradingResult
from kit.results.result_blocks import format_points


def write_markdown(result: GradingResult) -> str:
    """Writes a job summary in Markdown: a table, the rationales and the worst episode."""
    return "\n".join(_markdown_lines(result.for_student())) + "\n"


def _markdown_lines(result: GradingResult) -> Iterator[str]:
    points = (
        "no grade"
        if result.points is None
        else f"{format_points(result.points)} of {format_points(result.max_points)} points"
    )
    yield f"## {escape_markdown(result.assignment)}: {points}"
    yield ""
    yield "| Test | Outcome | Points |"
    yield "| --- | --- | ---: |"
    for test in result.tests:
        earned = f"{test.status.value} | {format_points(test.points)}/{format_points(test.max_points)}"
        yield f"| {escape_markdown(test.title)} | {'later |' if test.is_withheld else earned} |"
    for test in result.tests:
        if test.rationale and test.status is not CriterionStatus.PASS:
            yield ""
            yield f"**{escape_markdown(test.title)}**: {escape_markdown(test.rationale, 600)}"
            for hint in test.hints[:1]:
                yield f"\nHint: {escape_markdown(hint, 600)}"
    worst = next((test for test in result.tests if test.replay), None)
    if worst is not None:
        yield ""
        yield fenced_block(worst.replay)
    for notice in result.notices:
        yield ""
        yield f"_{escape_markdown(notice)}_"


FORMAT: Final = ReportFormat("markdown", write_markdown)
