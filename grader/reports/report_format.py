"""What a report format is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from kit.results.grading_result import GradingResult


@dataclass(frozen=True, slots=True)
class ReportFormat:
    """Writes a grading result for one reader, with the cleaning that its format needs."""

    name: str
    """On the command line."""
    write: Callable[[GradingResult], str]
    is_for_students: bool = True
    """Whether students read it as it is written, so that it leaves out what they may not see."""
