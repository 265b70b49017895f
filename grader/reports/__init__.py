"""Reports: one writer for each place a result is read, each with the cleaning that its format needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from types import MappingProxyType
from typing import Final

from kit.school.result import GradingResult


@dataclass(frozen=True, slots=True)
class Format:
    """One kind of report."""

    module: str
    """Its ``write(result) -> str`` is the writer."""
    about: str


FORMATS: Final[Mapping[str, Format]] = MappingProxyType(
    {
        "text": Format("terminal", "for people, in a terminal"),
        "json": Format("native", "the whole result, for programs"),
        "junit": Format("junit", "JUnit XML: GitLab, Jenkins, dashboards"),
        "gradescope": Format("gradescope", "Gradescope's results.json"),
        "classroom": Format("classroom", "GitHub Classroom's runner result"),
        "prairielearn": Format("prairielearn", "PrairieLearn's results.json"),
        "check50": Format("check50", "JSON in the manner of check50"),
        "markdown": Format("markdown", "a job summary"),
    }
)


def find_writer(name: str) -> Callable[[GradingResult], str]:
    """The writer of a format. KeyError if there is none."""
    write: Callable[[GradingResult], str] = import_module(f"grader.reports.{FORMATS[name].module}").write
    return write
