"""Report formats: each writes a grading result for one reader."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from pkgutil import iter_modules
from typing import Final

from grader.reports import formats
from grader.reports.report_format import ReportFormat


class _Formats(Mapping[str, ReportFormat]):
    """Each is imported when it is asked for: most need more of the kit than the one that a check writes."""

    def __init__(self) -> None:
        self._modules = {
            each.name.removesuffix("_report"): each.name for each in iter_modules(formats.__path__)
        }

    def __getitem__(self, name: str) -> ReportFormat:
        found: ReportFormat = import_module(f"{formats.__name__}.{self._modules[name]}").FORMAT
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(self._modules)

    def __len__(self) -> int:
        return len(self._modules)


FORMATS: Final[Mapping[str, ReportFormat]] = _Formats()
"""Every format by its name on the command line."""
