"""The result for people, in the lines of the kit's own renderer."""

from __future__ import annotations

import json
from typing import Final

from grader.reports.cleaning import clean_line
from grader.reports.formats.json_report import write_json
from grader.reports.report_format import ReportFormat
from kit.document.blocks import Block, Text
from kit.document.layout import lines_of, text_blocks
from kit.results.grading_result import GradingResult
from kit.results.result_blocks import INDENT, VERDICT_TEXTS, criterion_blocks, points_text

LOG_LINES = 8
"""Lines of a program's output shown."""


def write_text(result: GradingResult, *, hints: int = 1) -> str:
    """Writes the result for people, in the lines of the kit's own renderer, with the totals and the notices below: printable
    characters only. ``hints``: how many hints of a criterion to show."""
    return "\n".join(lines_of(_blocks(result, hints))) + "\n"


def _blocks(result: GradingResult, hints: int) -> list[Block]:
    # What the JSON report shows of a result is clean: no terminal escapes, no commands of a CI runner.
    shown = GradingResult.from_dict(json.loads(write_json(result)))
    more_hints = f"For more help, add --hints {hints + 1}."
    blocks: list[Block] = []
    for test in shown.tests:
        blocks += criterion_blocks(test, hints=hints, more_hints=more_hints, log_lines=LOG_LINES)
        if test.teacher_note:
            note = clean_line(f"With secret seeds: {test.teacher_note}", 600)
            blocks.append(Text(note, indent=INDENT, is_tight=True))
    points = "No grade" if shown.points is None else f"{points_text(shown.points, shown.max_points)} points"
    fingerprint = f"{shown.submission[:8]}-{shown.assignment_version[:8]}"
    return [
        *blocks,
        Text(f"{points}. {VERDICT_TEXTS[shown.verdict]}"),
        *text_blocks(map(clean_line, shown.notices)),
        Text(f"level {shown.level}, seeds {shown.seeds}, fingerprint {fingerprint}", is_tight=True),
    ]


FORMAT: Final = ReportFormat("text", write_text, is_for_students=False)
