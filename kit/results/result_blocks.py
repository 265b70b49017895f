"""A result as it is shown: points, the blocks of a criterion, and the picture of the first one that was lost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final

from kit.document.blocks import Picture, Text, Tone
from kit.plain_text import printable_line
from kit.results.grading_result import CriterionResult, CriterionStatus, GradingVerdict

INDENT: Final = 5
"""Columns before what is said of a criterion below its title."""
EVERYTHING: Final = "100 %"
"""What is expected where nothing needs to be said of it."""
MAX_RATIONALE: Final = 600
MAX_VALUE: Final = 300
"""Characters of an expected or actual value that are shown."""

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


def rounded_points(points: float) -> float:
    """Points with at most two decimals, for formats that show a number as it is written."""
    return round(points, 2)


def format_points(points: float) -> str:
    """Points with at most two decimals: ``3``, ``2.5``."""
    return f"{points:.2f}".rstrip("0").rstrip(".")


def points_text(points: float, max_points: float) -> str:
    """``2.5 of 4``"""
    return f"{format_points(points)} of {format_points(max_points)}"


def criterion_blocks(
    criterion: CriterionResult, *, hints: int = 0, more_hints: str = "", log_lines: int = 0
) -> list[Text | Picture]:
    """One criterion: mark, title and points; of one that is not passed also the rationale, the expected and the actual value
    where it does not name them, and the next steps.

    ``hints``: how many of its hints to show. ``more_hints``: how to see more, shown where there are more.
    ``log_lines``: how many of the last lines that a crashed program printed to show.
    """
    blocks: list[Text | Picture] = [_criterion_heading(criterion)]
    if criterion.is_passed:
        return blocks
    blocks.append(_paragraph(_shorten(criterion.rationale, MAX_RATIONALE)))
    # Words alone say no more than the title, and a share of all cases no more than the points.
    if any(map(str.isdigit, criterion.actual)) and criterion.expected != EVERYTHING:
        is_said = criterion.actual in criterion.rationale
        values = (("expected:", criterion.expected), ("actual:  ", criterion.actual))
        blocks += [
            _paragraph(_shorten(text), Tone.DIM, lead=name)
            for name, text in values
            if text and not (is_said and text in criterion.rationale)
        ]
    of = len(criterion.hints)
    blocks += [
        _paragraph(text, Tone.BOLD, lead=f"Hint {number} of {of}:")
        for number, text in enumerate(criterion.hints[:hints], 1)
    ]
    if more_hints and of > hints:
        blocks.append(_paragraph(more_hints, Tone.DIM))
    if log_lines and criterion.log:
        # A character before each: no line of a report begins with what a student's program printed.
        lines = tuple(f"| {printable_line(line)}" for line in criterion.log.splitlines()[-log_lines:])
        blocks.append(_paragraph("what the program printed:", Tone.DIM))
        blocks.append(Picture(lines, INDENT, Tone.DIM, is_tight=True))
    return [each for each in blocks if not isinstance(each, Text) or each.text]


def replay_lines(criteria: Sequence[CriterionResult]) -> list[str]:
    """The picture of the first criterion that was lost and has one; empty where none has."""
    picture = next((each.replay for each in criteria if not each.is_passed and each.replay), "")
    return picture.rstrip().splitlines()


def _criterion_heading(criterion: CriterionResult) -> Text:
    tone = Tone.GOOD if criterion.is_passed else Tone.BAD if criterion.is_judged else Tone.DIM
    points = "" if criterion.is_withheld else f": {points_text(criterion.points, criterion.max_points)}"
    return Text(
        " ".join(criterion.title.split()),
        Tone.PLAIN if criterion.is_passed else Tone.BOLD,
        lead=MARKS[criterion.status],
        lead_tone=tone,
        tail=points,
        hang=INDENT,
        is_tight=True,
    )


def _paragraph(text: str, tone: Tone = Tone.PLAIN, lead: str = "") -> Text:
    return Text(text, tone, lead=lead, lead_tone=tone, indent=INDENT, is_tight=True)


def _shorten(text: str, limit: int = MAX_VALUE) -> str:
    return text if len(text) <= limit else f"{text[:limit]} ... (shortened)"
