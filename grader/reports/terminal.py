"""The report for people in a terminal: the lines of the kit's own renderer, with the totals and the notices below.
Printable characters only."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterator

from grader.reports.cleaning import clean_line
from grader.reports.formats import write_json
from kit.school.result import GradingResult
from kit.school.result_text import INDENT, VERDICT_TEXTS, criterion_lines, line_text, points_text

WIDTH = 78
LOG_LINES = 8


def write_text(result: GradingResult, *, hints: int = 1) -> str:
    """Writes the result for people; ``hints``: how many hints of a criterion to show."""
    return "\n".join(_lines(result, hints)) + "\n"


def _lines(result: GradingResult, hints: int) -> Iterator[str]:
    # What the JSON report shows of a result is clean: no terminal escapes, no commands of a CI runner.
    shown = GradingResult.from_dict(json.loads(write_json(result)))
    more_hints = f"For more help, add --hints {hints + 1}."
    for test in shown.tests:
        for line in criterion_lines(test, WIDTH, hints=hints, more_hints=more_hints, log_lines=LOG_LINES):
            yield line_text(line)
        if test.teacher_note:
            note = clean_line(f"With secret seeds: {test.teacher_note}", 600)
            yield from textwrap.wrap(note, WIDTH, initial_indent=INDENT, subsequent_indent=INDENT)
    yield ""
    points = "No grade" if shown.points is None else f"{points_text(shown.points, shown.max_points)} points"
    yield f"{points}. {VERDICT_TEXTS[shown.verdict]}"
    for notice in shown.notices:
        yield from textwrap.wrap(clean_line(notice), WIDTH)
    yield (
        f"level {shown.level}, seeds {shown.seeds}, "
        f"fingerprint {shown.submission[:8]}-{shown.assignment_version[:8]}"
    )
