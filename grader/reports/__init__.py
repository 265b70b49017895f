"""Report formats: each writes a grading result for one reader."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pkgutil import iter_modules
from types import MappingProxyType
from typing import Final

from grader.reports import formats
from grader.reports.report_format import ReportFormat

_FOUND: Final[list[ReportFormat]] = [
    import_module(f"{formats.__name__}.{module.name}").FORMAT for module in iter_modules(formats.__path__)
]

FORMATS: Final[Mapping[str, ReportFormat]] = MappingProxyType({each.name: each for each in _FOUND})
"""Every format by its name on the command line."""
