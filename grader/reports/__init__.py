"""Report formats: each writes a grading result for one reader, with the cleaning that its format needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from grader.reports.formats import (
    write_annotations,
    write_check50,
    write_classroom,
    write_classroom50,
    write_gradescope,
    write_json,
    write_junit,
    write_markdown,
    write_prairielearn,
    write_text,
)
from kit.results.grading_result import GradingResult

ReportWriter = Callable[[GradingResult], str]

FORMATS: Final[Mapping[str, ReportWriter]] = MappingProxyType(
    {
        "text": write_text,
        "json": write_json,
        "junit": write_junit,
        "gradescope": write_gradescope,
        "classroom": write_classroom,
        "classroom50": write_classroom50,
        "annotations": write_annotations,
        "prairielearn": write_prairielearn,
        "check50": write_check50,
        "markdown": write_markdown,
    }
)
"""Every format by its name on the command line."""

STUDENT_FORMATS: Final = frozenset(FORMATS) - {"text", "json"}
"""Formats that students read as they are written."""
