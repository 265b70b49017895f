"""For people in a terminal: a line per criterion, what was wrong, and what to do next. Plain characters only."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Final

from grader.reports.cleaning import indented, one_line
from grader.result import Result, Status, Test, Verdict, amount

WIDTH: Final = 78

MARKS: Final[Mapping[Status, str]] = MappingProxyType(
    {
        Status.PASS: "[ok]  ",
        Status.PARTIAL: "[part]",
        Status.FAIL: "[no]  ",
        Status.STUDENT_ERROR: "[stop]",
        Status.TIMEOUT: "[slow]",
        Status.RESOURCE_LIMIT: "[big] ",
        Status.PROTOCOL_ERROR: "[odd] ",
        Status.SKIPPED: "[later]",
        Status.GRADER_ERROR: "[????]",
    }
)
"""Words, not colours: they survive a pipe and a screen reader."""

ENDINGS: Final[Mapping[Verdict, str]] = MappingProxyType(
    {
        Verdict.PASS: "All tests that ran here passed.",
        Verdict.FAIL: "Not yet.",
        Verdict.BROKEN: "The grader itself is broken: no grade was given, nothing was lost.",
    }
)


def write(result: Result, *, hints: int = 1) -> str:
    """``hints``: how many of the hint steps to show."""
    return "\n".join(lines(result, hints)) + "\n"


def lines(result: Result, hints: int) -> Iterator[str]:
    for test in result.tests:
        yield from _test(test, hints)
    yield ""
    points = (
        "no grade"
        if result.points is None
        else f"{amount(result.points)} of {amount(result.max_points)} points"
    )
    yield f"{points}. {ENDINGS[result.verdict]}"
    for notice in result.notices:
        yield from textwrap.wrap(one_line(notice), WIDTH)
    yield f"level {result.level}, seeds {result.seeds}, fingerprint {result.submission[:8]}-{result.assignment_version[:8]}"


def _test(test: Test, hints: int) -> Iterator[str]:
    points = f"{amount(test.points)}/{amount(test.max_points)}"
    yield f"{MARKS[test.status]:<7} {one_line(test.title, 56):<56} {points:>11}"
    margin = " " * 8
    if test.rationale:
        yield from textwrap.wrap(
            one_line(test.rationale, 600), WIDTH, initial_indent=margin, subsequent_indent=margin
        )
    if test.status is Status.PARTIAL or test.status is Status.FAIL:
        if test.actual:
            yield f"{margin}expected {one_line(test.expected)}, got {one_line(test.actual)}"
        for number, hint in enumerate(test.hints[:hints], 1):
            yield from textwrap.wrap(
                f"hint {number} of {len(test.hints)}: {one_line(hint, 600)}",
                WIDTH,
                initial_indent=margin,
                subsequent_indent=margin,
            )
        if len(test.hints) > hints:
            yield f"{margin}more help: add --hints {hints + 1}"
    if test.log and test.status in (Status.STUDENT_ERROR, Status.GRADER_ERROR):
        yield f"{margin}what it printed:"
        yield indented("\n".join(test.log.splitlines()[-8:]), f"{margin}| ")
