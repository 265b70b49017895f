"""A job summary in Markdown: a table, what was wrong, and the worst episode. At most a few kilobytes."""

from __future__ import annotations

from collections.abc import Iterator

from grader.reports.cleaning import fenced, markdown
from kit.school.result import CriterionStatus, GradingResult, format_points


def write(result: GradingResult) -> str:
    return "\n".join(_lines(result.for_student())) + "\n"


def _lines(result: GradingResult) -> Iterator[str]:
    points = (
        "no grade"
        if result.points is None
        else f"{format_points(result.points)} of {format_points(result.max_points)} points"
    )
    yield f"## {markdown(result.assignment)}: {points}"
    yield ""
    yield "| Test | Outcome | Points |"
    yield "| --- | --- | ---: |"
    for test in result.tests:
        yield f"| {markdown(test.title)} | {test.status.value} | {format_points(test.points)}/{format_points(test.max_points)} |"
    for test in result.tests:
        if test.rationale and test.status is not CriterionStatus.PASS:
            yield ""
            yield f"**{markdown(test.title)}**: {markdown(test.rationale, 600)}"
            for hint in test.hints[:1]:
                yield f"\nHint: {markdown(hint, 600)}"
    worst = next((test for test in result.tests if test.replay), None)
    if worst is not None:
        yield ""
        yield fenced(worst.replay)
    for notice in result.notices:
        yield ""
        yield f"_{markdown(notice)}_"
