"""The whole result as JSON, with cleaned texts."""

from __future__ import annotations

import json
from typing import Any, Final

from grader.reports.cleaning import plain
from grader.reports.report_format import ReportFormat
from kit.results.grading_result import GradingResult


def write_json(result: GradingResult) -> str:
    """Writes the whole result as JSON, with cleaned texts."""
    return json.dumps(_clean_json(result.as_dict()), indent=2, sort_keys=True, allow_nan=False) + "\n"


def _clean_json(content: Any) -> Any:
    if isinstance(content, str):
        return plain(content, 20_000)
    if isinstance(content, dict):
        return {key: _clean_json(value) for key, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [_clean_json(value) for value in content]
    return content


FORMAT: Final = ReportFormat("json", write_json, is_for_students=False)
