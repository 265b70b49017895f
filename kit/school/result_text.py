"""Renders a grading result as lines of text, for the screens, the line mode and the grader's terminal output.

A line is a sequence of spans with a role each. What a line says never depends on the roles: a screen may show them
as colours, ``plain`` leaves them out.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from enum import Enum, auto
from types import MappingProxyType
from typing import Final, NamedTuple

from kit.school.result import CriterionResult, CriterionStatus, GradingVerdict, format_points

INDENT: Final = " " * 5
MIN_WIDTH: Final = 20
MAX_RATIONALE: Final = 600
MAX_VALUE: Final = 300
"""Characters of an expected or actual value that are shown."""


class TextRole(Enum):
    """The role of a span in its line, by which a screen can colour it."""

    PASSED = auto()
    LOST = auto()
    NOT_JUDGED = auto()
    PLAIN = auto()
    HEADING = auto()
    DETAIL = auto()
    HINT = auto()


class TextSpan(NamedTuple):
    text: str
    role: TextRole


TextLine = tuple[TextSpan, ...]

MARKS: Final[Mapping[CriterionStatus, str]] = MappingProxyType(
    {
        CriterionStatus.PASS: "[ok]",
        CriterionStatus.PARTIAL: "[part]",
        CriterionStatus.FAIL: "[no]",
        CriterionStatus.STUDENT_ERROR: "[error]",
        CriterionStatus.TIMEOUT: "[timeout]",
        CriterionStatus.RESOURCE_LIMIT: "[limit]",
        CriterionStatus.PROTOCOL_ERROR: "[error]",
        CriterionStatus.SKIPPED: "[--]",
        CriterionStatus.GRADER_ERROR: "[grader error]",
    }
)
"""Words, not colours: they survive a pipe and a screen reader."""

VERDICT_TEXTS: Final[Mapping[GradingVerdict, str]] = MappingProxyType(
    {
        GradingVerdict.PASS: "All tests that ran here passed.",
        GradingVerdict.FAIL: "Not passed yet.",
        GradingVerdict.BROKEN: "The grader failed: there is no grade, and no points were lost.",
    }
)


def line_text(line: TextLine) -> str:
    """The line without its roles."""
    return "".join(span.text for span in line)


def points_text(points: float, max_points: float) -> str:
    """``2.5 of 4``"""
    return f"{format_points(points)} of {format_points(max_points)}"


def criterion_lines(
    criterion: CriterionResult, width: int, *, hints: int = 0, more_hints: str = "", log_lines: int = 0
) -> Iterator[TextLine]:
    """The lines of one criterion, at most ``width`` characters each: mark, title and points; of one that is not
    passed also the rationale, the expected and the actual value, and the next steps.

    ``hints``: how many of its hints to show. ``more_hints``: how to see more, shown where there are more.
    ``log_lines``: how many of the last lines that a crashed program printed to show.
    """
    yield from _heading_lines(criterion, width)
    if criterion.is_passed:
        return
    yield from _paragraph_lines(_shortened(criterion.rationale, MAX_RATIONALE), TextRole.PLAIN, width)
    if criterion.actual:
        if criterion.expected:
            yield from _paragraph_lines(f"expected: {_shortened(criterion.expected)}", TextRole.DETAIL, width)
        yield from _paragraph_lines(f"actual:   {_shortened(criterion.actual)}", TextRole.DETAIL, width)
    for number, hint in enumerate(criterion.hints[:hints], 1):
        yield from _paragraph_lines(f"Hint {number} of {len(criterion.hints)}: {hint}", TextRole.HINT, width)
    if more_hints and len(criterion.hints) > hints:
        yield from _paragraph_lines(more_hints, TextRole.DETAIL, width)
    if log_lines and criterion.log:
        yield (TextSpan(f"{INDENT}what the program printed:", TextRole.DETAIL),)
        # A character before each: no line of a report begins with what a student's program printed.
        for line in criterion.log.splitlines()[-log_lines:]:
            yield (TextSpan(f"{INDENT}| {line}", TextRole.DETAIL),)


def replay_lines(criteria: Sequence[CriterionResult]) -> list[str]:
    """The picture of the first criterion that was lost and has one; empty where none has."""
    picture = next((each.replay for each in criteria if not each.is_passed and each.replay), "")
    return picture.rstrip().splitlines()


def _heading_lines(criterion: CriterionResult, width: int) -> Iterator[TextLine]:
    mark = MARKS[criterion.status]
    role = (
        TextRole.PASSED
        if criterion.is_passed
        else TextRole.LOST
        if criterion.is_judged
        else TextRole.NOT_JUDGED
    )
    title_role = TextRole.PLAIN if criterion.is_passed else TextRole.HEADING
    points = "" if criterion.is_withheld else f": {points_text(criterion.points, criterion.max_points)}"
    title = " ".join(criterion.title.split())
    # The points stay with the title's last word: they are wrapped as one word, and taken off again.
    wrapped = textwrap.wrap(
        title + "\0" * len(points),
        max(MIN_WIDTH, width),
        initial_indent=" " * (len(mark) + 1),
        subsequent_indent=INDENT,
    )
    for number, line in enumerate(wrapped):
        text = line.rstrip("\0")
        head: TextLine = (TextSpan(mark, role), TextSpan(" ", TextRole.PLAIN)) if number == 0 else ()
        body = TextSpan(text[len(mark) + 1 :] if number == 0 else text, title_role)
        tail: TextLine = (TextSpan(points, TextRole.DETAIL),) if number == len(wrapped) - 1 else ()
        yield (*head, body, *tail)


def _paragraph_lines(text: str, role: TextRole, width: int) -> Iterator[TextLine]:
    for part in text.splitlines():
        for line in textwrap.wrap(
            part, max(MIN_WIDTH, width), initial_indent=INDENT, subsequent_indent=INDENT
        ):
            yield (TextSpan(line, role),)


def _shortened(text: str, limit: int = MAX_VALUE) -> str:
    return text if len(text) <= limit else f"{text[:limit]} ... (shortened)"
