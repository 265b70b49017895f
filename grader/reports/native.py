"""The whole result as JSON, for programs: nothing is left out, texts are cleaned."""

from __future__ import annotations

import json
from typing import Any

from grader.reports.cleaning import plain
from kit.school.result import GradingResult


def write(result: GradingResult) -> str:
    return json.dumps(_clean(result.as_dict()), indent=2, sort_keys=True, allow_nan=False) + "\n"


def _clean(content: Any) -> Any:
    if isinstance(content, str):
        return plain(content, 20_000)
    if isinstance(content, dict):
        return {key: _clean(value) for key, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [_clean(value) for value in content]
    return content
